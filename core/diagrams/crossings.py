"""Where edges of polygons cross in the plane."""

from dataclasses import dataclass

import numpy as np

from ..curve import Mesh
from ..types import FloatArray, IntArray

_ROWS = 64  # of edge pairs looked at together


@dataclass(frozen=True, eq=False)
class PlaneCrossings:
    """Pairs of edges without a common vertex whose inner points cross.

    Attributes
    ----------
    first, second
        The edges, ``first < second``; shape (k,).
    first_at, second_at
        Where on them, as fractions of their lengths; shape (k,).
    turn
        Cross product of the first edge's vector with the second's, positive if the second crosses from right to left.
    """

    first: IntArray
    second: IntArray
    first_at: FloatArray
    second_at: FloatArray
    turn: FloatArray

    @property
    def ends(self) -> tuple[tuple[IntArray, FloatArray], tuple[IntArray, FloatArray]]:
        """Edges and fractions of the first and of the second passes."""
        return (self.first, self.first_at), (self.second, self.second_at)


def plane_crossings(mesh: Mesh, points: FloatArray) -> PlaneCrossings:
    """Find all crossings of polygons; of ``points``, shape (n, 2 or more), only x and y are looked at."""
    rows = [_found(mesh, points, first) for first in range(0, mesh.size, _ROWS)]
    i, j, s, t, turn = np.concatenate(rows, axis=1)
    return PlaneCrossings(i.astype(np.intp), j.astype(np.intp), s, t, turn)


def _found(mesh: Mesh, points: FloatArray, first: int) -> FloatArray:
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
