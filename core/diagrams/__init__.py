"""Link diagrams: read off polygons or codes, simplified, cut into factors, and their polynomials."""

from .alexander import alexander
from .bracket import Laurent, doubled_bracket, jones, normalized_bracket
from .diagram import Diagram, Pass, PlanarCrossing
from .factors import factors
from .planar_codes import diagram_of
from .projection import views
from .realize import realized
from .signature import knot_signature
from .simplify import is_least, shuffled_down, simplified

__all__ = [
    "Diagram",
    "Laurent",
    "Pass",
    "PlanarCrossing",
    "alexander",
    "diagram_of",
    "doubled_bracket",
    "factors",
    "is_least",
    "jones",
    "knot_signature",
    "normalized_bracket",
    "realized",
    "shuffled_down",
    "simplified",
    "views",
]
