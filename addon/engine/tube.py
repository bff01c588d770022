"""How thick a tube may be drawn around a curve without running into anything; for pictures, proves nothing."""

from collections.abc import Sequence

import numpy as np

from ...core import Curve, Obstacle
from ...core.collision.clearance import clears
from ...core.curve.distances import nearest_strands
from ...core.types import FloatArray

_THICKEST = 0.016  # of a component's length: a round circle's tube is then a tenth of its radius
_DISTINCT = 3.0  # two points lie on different strands if they are this many times further apart along the curve
AIR = 0.94  # of half the gap, so that strands do not seem to touch
_FINE = 8.0  # edges this many times shorter than a distance tell it
_FEWEST = 16  # vertices of a component that is thinned


def thickest_radius(curve: Curve) -> float:
    """Radius that looks right where there is room enough."""
    return _THICKEST * curve.length / len(curve.mesh.component_sizes)


def free_radius(curve: Curve, thickest: float) -> float:
    """Half the gap between strands of a curve, at most ``thickest``."""
    return min(thickest, 0.5 * AIR * strand_gap(curve, 2 * thickest / AIR))


def radius_beside(curve: Curve, radius: float, obstacles: Sequence[Obstacle]) -> float:
    """A radius, or as much less, to 2 %, as obstacles leave room for; at least a thousandth of it."""

    def fits(thick: float) -> bool:
        return clears(_thinned(curve, thick), obstacles, thick / AIR)

    if not obstacles or fits(radius):
        return radius
    low, high = 1e-3 * radius, radius
    while high > 1.02 * low:
        middle = float(np.sqrt(low * high))
        low, high = (middle, high) if fits(middle) else (low, middle)
    return low


def strand_gap(curve: Curve, widest: float) -> float:
    """Least distance between strands of a curve, inf if it is more than ``widest``, to 1 %.

    Where edges are much shorter than that, some of the vertices tell as much as all of them, which make too many pairs;
    where these say that strands are near, more of them look for what is nearer still.
    """
    while True:
        some = _thinned(curve, widest)
        spacing = float(some.edge_lengths.max())
        nearest = nearest_strands(some, _DISTINCT, widest + spacing)
        if some is curve or nearest >= 0.5 * widest:
            return float(between_edges(nearest, spacing))
        widest = nearest


def between_edges(ends: FloatArray | float, lengths: FloatArray | float) -> FloatArray:
    """How near edges are whose ends are so far apart; no nearer, where the ends of the nearest two lie side by side."""
    return np.asarray(np.sqrt(np.maximum(np.square(ends) - 0.25 * np.square(lengths), 0.25 * np.square(ends))))


def _thinned(curve: Curve, distance: float) -> Curve:
    """A curve with as few vertices, a few at least of each component, as tell such a distance; itself if all do."""
    stride = int(distance / (_FINE * curve.edge_lengths.max()))
    if stride <= 1:
        return curve
    steps = [max(1, min(stride, len(each) // _FEWEST)) for each in curve.components]
    pieces = [np.concatenate([p[:-1:k], p[-1:]]) for p, k in zip(curve.components, steps, strict=True)]
    return Curve.from_components(pieces, curve.mesh.closed)
