"""Diagrams of polygons in space: what is seen of them from some direction."""

from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ..curve import Curve, Mesh
from ..errors import CurveError
from ..types import FloatArray, IntArray
from .diagram import Diagram, Pass

_TILT = 0.02  # radians, about, by which the flattest view is turned, so that nothing special is seen
_ROWS = 64  # of edge pairs looked at together


def views(curve: Curve, count: int, seed: int = 20217, clear: float = 1e-9) -> Iterator[Diagram]:
    """Diagrams of a closed polygon in space: first from where it looks flattest, then from random directions.

    Directions in which rounding might decide what crosses what are left out: where a crossing is nearer to another
    strand, or to the end of an edge, than ``clear``, a fraction of the curve's size or the edge's length.  Raises
    CurveError if there is no other direction.
    """
    rng = np.random.default_rng(seed)
    _, power = np.frexp(np.abs(curve.vertices).max())
    points = np.ldexp(curve.vertices, -power)  # where products of coordinates neither overflow nor vanish
    middle = points - points.mean(axis=0)
    flattest = np.linalg.svd(middle, full_matrices=False)[2] + _TILT * rng.normal(size=(3, 3))
    every = (_seen(curve, middle @ _rotation(each), clear) for each in (flattest, *rng.normal(size=(count - 1, 3, 3))))
    none = True
    for diagram in filter(None, every):
        none = False
        yield diagram
    if none:
        raise CurveError("strands touch, or nearly do: no view of the curve shows which one is in front")


def _rotation(frame: FloatArray) -> FloatArray:
    """The rotation to axes near the rows of a matrix."""
    q, r = np.linalg.qr(frame.T)
    q = q * np.sign(np.diag(r))
    return np.asarray(q * [1.0, 1.0, np.sign(np.linalg.det(q))])


def _seen(curve: Curve, points: FloatArray, clear: float) -> Diagram | None:
    """The diagram of points, shape (n, 3), as seen along z; None if it is unclear."""
    edges, at, turn = plane_crossings(curve.mesh, points)
    heights = points[curve.mesh.tails[edges], 2] * (1.0 - at) + points[curve.mesh.heads[edges], 2] * at
    above = heights[0] > heights[1]
    size = float(np.abs(points).max())
    margin = min(
        at.min(initial=1.0), 1.0 - at.max(initial=0.0), np.abs(heights[0] - heights[1]).min(initial=size) / size
    )
    if margin < clear:
        return None
    signs = np.sign(np.where(above, turn, -turn)).astype(int).tolist()
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
    return diagram if diagram.is_planar else None


class PlaneCrossings(NamedTuple):
    """Pairs of edges without a common vertex whose inner points cross in the plane."""

    edges: IntArray  # ascending in each pair; shape (2, k)
    at: FloatArray  # where on them, as fractions of their lengths; shape (2, k)
    turn: FloatArray  # cross product of their vectors, positive if the second crosses from right to left; shape (k,)


def plane_crossings(mesh: Mesh, points: FloatArray) -> PlaneCrossings:
    """Find all crossings of polygons; of ``points``, shape (n, 2 or more), only x and y are looked at."""
    found = np.concatenate([_crossings_of(mesh, points, first) for first in range(0, mesh.size, _ROWS)], axis=1)
    return PlaneCrossings(found[:2].astype(np.intp), found[2:4], found[4])


def _crossings_of(mesh: Mesh, points: FloatArray, first: int) -> FloatArray:
    """Crossings of a block of edges with later ones, as rows: both edges, where on them, and the turn."""
    i = np.arange(first, min(first + _ROWS, mesh.size))[:, None]
    j = _near(mesh, points, i.ravel())[None, :]
    start, edge = points[mesh.tails], points[mesh.heads] - points[mesh.tails]
    apart = start[j] - start[i]
    turn = edge[i, 0] * edge[j, 1] - edge[i, 1] * edge[j, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        s = (apart[..., 0] * edge[j, 1] - apart[..., 1] * edge[j, 0]) / turn
        t = (apart[..., 0] * edge[i, 1] - apart[..., 1] * edge[i, 0]) / turn
    neighbours = (mesh.heads[i] == j) | (mesh.heads[j] == i)
    a, b = np.nonzero((j > i) & ~neighbours & (s > 0) & (s < 1) & (t > 0) & (t < 1))
    return np.array([a + first, j[0, b], s[a, b], t[a, b], turn[a, b]], dtype=np.float64)


def _near(mesh: Mesh, points: FloatArray, block: IntArray) -> IntArray:
    """Edges from the block's first on whose box meets the box around the block."""
    later = np.arange(block[0], mesh.size)
    low = np.minimum(points[mesh.tails[later], :2], points[mesh.heads[later], :2])
    high = np.maximum(points[mesh.tails[later], :2], points[mesh.heads[later], :2])
    own = slice(len(block))
    meets = (low <= high[own].max(axis=0)) & (high >= low[own].min(axis=0))
    return np.asarray(later[meets.all(axis=1)])
