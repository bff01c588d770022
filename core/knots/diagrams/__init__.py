"""Link diagrams: read off polygons or codes, simplified, cut into factors, and their invariants."""

from .diagram import Diagram, Pass, PlanarCrossing, diagram_of
from .invariants import (
    Laurent,
    QuickInvariants,
    alexander,
    doubled_bracket,
    jones,
    linking_numbers,
    normalized_bracket,
    quick_invariants,
    signature,
    unsigned_linking,
)
from .projection import views
from .rerouting import factors, is_least, shuffled_down, simplified, simplifying
