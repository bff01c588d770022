"""Which knots of the table a curve may be, by its Alexander polynomial."""

from functools import cache

from ..curve import Curve
from .alexander import Signature, signature
from .shapes import shapes, smooth_knot


def names_alike(curve: Curve, crossings: int) -> list[str]:
    """Names of the prime knots of the table that a diagram may show: no more crossings, and equal signatures.

    Mirror images are not told apart. Up to ten crossings the signature of 0_1 proves the unknot, since no other knot of
    so few has a trivial Alexander polynomial.

    Parameters
    ----------
    curve
        One closed polygon in space; there are no names for links, nor for arcs.
    crossings
        Number of crossings of a diagram of it.
    """
    if curve.mesh.closed != (True,):
        return []
    found = signature(curve)
    return [name for name in shapes() if _crossings(name) <= crossings and _signature(name) == found]


def _crossings(name: str) -> float:
    """Crossing number in a knot's name, infinite for links."""
    number = name.partition("_")[0]
    return int(number) if number.isdigit() else float("inf")


@cache
def _signature(name: str) -> Signature:
    return signature(smooth_knot(name))
