"""Sort out pairs that certainly do not meet during a leg, in floating-point numbers with error bounds."""

from collections.abc import Iterator, Sequence
from itertools import chain

import numpy as np

from ..base import FloatArray, IntArray
from ..base.tolerances import SIEVE_UNDERFLOW
from .checker import Points, Polygons
from .crowded import crowded
from .planes import doubtful, overlapping, really_overlapping


class FloatingSieve:
    """The pairs on a leg that the checker must decide: what it asks instead of `checker.Nearby`."""

    def __init__(self, triangles: Sequence[Points]) -> None:
        self.triangles = np.array(triangles, dtype=np.float64).reshape(-1, 3, 3)
        self._last: tuple[Points, FloatArray] = [], np.empty((0, 3))  # each leg begins where the one before ends

    def __call__(self, start: Points, end: Points, polygons: Polygons, clearance: float) -> Iterator[tuple[int, ...]]:
        """Yield x₀, x₁, y₀, y₁ of pairs of edges, and x₀, x₁ and the triangle's number; see `checker.Nearby`."""
        before, after = map(self._rows, (start, end))
        for batch in doubtful_pairs(before, after, np.array(polygons.heads), clearance, self.triangles):
            yield from zip(*batch.tolist(), strict=True)

    def crowded(
        self, start: Points, end: Points, polygons: Polygons, radius: Sequence[float]
    ) -> Iterator[tuple[int, int, int | None]]:
        """Yield what of a rope must be decided; see `checker.Nearby`."""
        before, after = map(self._rows, (start, end))
        yield from crowded(before, after, polygons, radius, self.triangles)

    def _rows(self, points: Points) -> FloatArray:
        if self._last[0] is not points:
            self._last = points, np.fromiter(chain.from_iterable(points), np.float64).reshape(len(points), -1)
        return self._last[1]


def doubtful_pairs(
    start: FloatArray, end: FloatArray, heads: IntArray, clearance: float = 0.0, triangles: FloatArray | None = None
) -> Iterator[IntArray]:
    """Yield the pairs of edges, and of edges and triangles, that are not proved apart as vertices go from start to end.

    Non-neighbour edges; in closed polygons of three edges, which have none of these, each vertex, as an edge of no
    length, with the opposite edge; and each end of an open polygon with the edge after its neighbour.  Start and end
    are vertices, shape (n, m) with m = 2 or 3; ``heads``, shape (n,), is the vertex that the edge from each vertex
    leads to: the vertex itself where an open polygon ends.  Triangles, shape (k, 3, 3), are at rest.  Pairs stay apart
    even if every coordinate of every vertex is wrong by the clearance.

    Yields the vertices x₀, x₁, y₀, y₁ of a bounded number of pairs, shape (4, pairs), or x₀, x₁ and the triangle.
    """
    n = len(start)
    if triangles is not None and len(triangles):  # their corners come after the vertices
        start, end = (np.concatenate([points, triangles.reshape(-1, 3)]) for points in (start, end))
    exponent = -int(np.frexp(max(np.abs(start).max(), np.abs(end).max()))[1])  # coordinates are at most 1 in size
    start, end = np.ldexp(start, exponent), np.ldexp(end, exponent)
    if clearance:
        clearance = max(float(np.ldexp(clearance, exponent)), SIEVE_UNDERFLOW)
    for vertices in _nearby(start, end, heads, clearance):
        if (kept := doubtful(start, end, vertices, clearance)).size:
            yield kept if len(kept) == 4 else np.stack([*kept[:2], (kept[2] - n) // 3])


def _nearby(start: FloatArray, end: FloatArray, heads: IntArray, clearance: float) -> Iterator[IntArray]:
    """Vertices of pairs that may meet, as their boxes overlap; shapes (4 or 5, pairs).

    Ranges are compared and never divided, and rounding keeps the order of values scaled, lowered or raised: no
    overlapping pair is taken to be apart.
    """
    n, here = len(heads), np.arange(len(heads))
    # What must not meet although it is neighbours: each vertex of a triangle, twice, and the ends of the opposite edge;
    # each end of an open polygon, twice, and the two vertices after it, the same one if it is the last.
    before, tails = here.copy(), np.flatnonzero(heads != here)
    before[heads[tails]] = tails
    triangles = tails[heads[heads[heads[tails]]] == tails]
    folds = (triangles, heads), (np.flatnonzero(before == here), heads), (np.flatnonzero(heads == here), before)
    yield np.concatenate([np.stack([k, k, way[k], way[way[k]]]) for k, way in folds], axis=1)

    ends = np.stack([start[tails], end[tails], start[heads[tails]], end[heads[tails]]])
    low, high = ends.min(axis=0) - 4 * clearance, ends.max(axis=0) + 4 * clearance
    for i, j in overlapping((low, high)):
        i, j = tails[i], tails[j]
        keep = (heads[i] != j) & (heads[j] != i)
        i, j = i[keep], j[keep]
        yield np.stack([i, heads[i], j, heads[j]])

    corners = start[n:].reshape(-1, 3, start.shape[1])
    if not len(corners):
        return
    still = corners.min(axis=1), corners.max(axis=1)
    # runs of neighbouring edges, whose own box, made without rounding, overlaps all that theirs do, come first
    size = 16
    starts = np.arange(0, len(tails), size)
    runs = np.minimum.reduceat(low, starts), np.maximum.reduceat(high, starts)
    for run, j in overlapping(runs, still):
        i, j = (size * run + np.arange(size)[:, None]).ravel(), np.tile(j, size)
        i, j = really_overlapping((low, high), still, i[i < len(tails)], j[i < len(tails)])
        yield np.stack([tails[i], heads[tails[i]], *(n + 3 * j + k for k in range(3))])
