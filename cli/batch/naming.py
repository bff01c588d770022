"""What knots are called in the table of results."""

from ...core import Curve
from ...core.knots.recognition import names_alike

CROSSINGS = 10  # of the knots that are looked for: those of the table


def knot_type(curve: Curve) -> str:
    """The names that a curve may have in the knot table, joined by "or"; empty for links and what is not in it."""
    if curve.dimension != 3:
        return ""
    return " or ".join(names_alike(curve, CROSSINGS))
