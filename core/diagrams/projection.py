"""Diagrams of polygons in space: what is seen of them from some direction."""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from ..curve import Curve
from ..types import FloatArray
from .crossings import plane_crossings
from .diagram import Diagram, Pass
from .faces import Faces

_TILT = 0.02  # radians, about, by which the flattest view is turned, so that nothing special is seen
_CLEAR = 1e-9  # of an edge, or of the curve's size: what is nearer to the limit than that might be a rounding error


def views(curve: Curve, count: int, seed: int = 20217, clear: float = _CLEAR) -> Iterator[Diagram]:
    """Diagrams of a closed polygon in space: first from where it looks flattest, then from random directions.

    Directions in which it can not be told for certain what crosses what are left out: where a crossing is nearer to
    another strand, or to the end of an edge, than ``clear``, a fraction of the curve's size or the edge's length.
    """
    rng = np.random.default_rng(seed)
    _, power = np.frexp(np.abs(curve.vertices).max())
    points = np.ldexp(curve.vertices, -power)  # where products of coordinates neither overflow nor vanish
    middle = points - points.mean(axis=0)
    flattest = np.linalg.svd(middle, full_matrices=False)[2] + _TILT * rng.normal(size=(3, 3))
    for frame in (flattest, *rng.normal(size=(count - 1, 3, 3))):
        found = _seen(curve, middle @ _rotation(frame), clear)
        if found is not None:
            yield found


def _rotation(frame: FloatArray) -> FloatArray:
    """The rotation to axes near the rows of a matrix."""
    q, r = np.linalg.qr(frame.T)
    q = q * np.sign(np.diag(r))
    return np.asarray(q * [1.0, 1.0, np.sign(np.linalg.det(q))])


def _seen(curve: Curve, points: FloatArray, clear: float) -> Diagram | None:
    """The diagram of points, shape (n, 3), as seen along z; None if it is unclear."""
    found = plane_crossings(curve.mesh, points)
    edges = np.stack([found.first, found.second])
    at = np.stack([found.first_at, found.second_at])
    heights = points[curve.mesh.tails[edges], 2] * (1.0 - at) + points[curve.mesh.heads[edges], 2] * at
    above = heights[0] > heights[1]
    size = float(np.abs(points).max())
    margin = min(
        at.min(initial=1.0), 1.0 - at.max(initial=0.0), np.abs(heights[0] - heights[1]).min(initial=size) / size
    )
    if margin < clear:
        return None
    signs = np.sign(np.where(above, found.turn, -found.turn)).astype(int).tolist()
    along = (edges + at).ravel()
    upper = np.concatenate([above, ~above])
    crossing = np.tile(np.arange(len(signs)), 2)
    order = np.argsort(along)
    ends = np.searchsorted(along[order], curve.mesh.offsets)
    passes: list[tuple[Pass, ...]] = []
    for a, b in pairwise(ends.tolist()):
        part = order[a:b]
        passes.append(tuple(zip(crossing[part].tolist(), upper[part].tolist(), strict=True)))
    diagram = Diagram(tuple(passes), tuple(signs))
    return diagram if Faces(diagram).is_planar else None
