"""Which knots of the table a curve may be, by its Alexander polynomial."""

from enum import Enum
from functools import cache

import numpy as np

from ..curve import Curve
from .alexander import Signature, signature
from .crossings import plane_crossings
from .shapes import shapes, smooth_knot

TABLED = 10  # crossings up to which the unknot alone has a trivial Alexander polynomial
VIEWS = 10  # projections that are looked at


class Unknotted(Enum):
    """What the Alexander polynomial tells of a knot."""

    YES = "it is the unknot"
    MAYBE = "its polynomial is that of the unknot"
    NO = "it is knotted"


def unknotted(curve: Curve) -> Unknotted:
    """Tell whether one closed polygon in space is the unknot, as far as that is quickly done."""
    if not signature(curve).is_trivial:
        return Unknotted.NO
    rng = np.random.default_rng(0)
    views = (np.linalg.qr(rng.normal(size=(3, 3)))[0] for _ in range(VIEWS))
    crossings = min(len(plane_crossings(curve.mesh, curve.vertices @ view).first) for view in views)
    return Unknotted.YES if crossings <= TABLED else Unknotted.MAYBE


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
