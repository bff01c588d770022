"""Link diagrams: read off polygons or codes, simplified, cut into factors, and their invariants."""

from .diagram import Diagram, Pass, PlanarCrossing, diagram_of
from .invariants import QuickInvariants, linking_numbers, quick_invariants, signature
from .polynomials import Laurent, alexander, doubled_bracket, jones, normalized_bracket
from .projection import views
from .realize import realized
from .rerouting import factors, is_least, shuffled_down, simplified
