"""Link diagrams: read off polygons or codes, simplified, cut into factors, and their invariants."""

from .diagram import Diagram, Pass, PlanarCrossing, diagram_of
from .invariants import QuickInvariants, linking_numbers, quick_invariants, signature
from .polynomials import Laurent, alexander, doubled_bracket, jones, normalized_bracket
from .projection import views
from .realize import realized
from .rerouting import factors, is_least, shuffled_down, simplified

__all__ = [
    "Diagram",
    "Laurent",
    "Pass",
    "PlanarCrossing",
    "QuickInvariants",
    "alexander",
    "diagram_of",
    "doubled_bracket",
    "factors",
    "is_least",
    "jones",
    "linking_numbers",
    "normalized_bracket",
    "quick_invariants",
    "realized",
    "shuffled_down",
    "signature",
    "simplified",
    "views",
]
