"""Sort out pairs that certainly do not meet during a leg, in floating-point numbers with error bounds."""

from collections.abc import Callable, Iterator, Sequence
from itertools import chain, combinations
from typing import Literal

import numpy as np

from ..base.types import BoolArray, FloatArray, IntArray
from .checker import Points, Polygons

# Bound of the rounding errors of the sums of products below, relative to the sum of the absolute values: differences
# of coordinates are exact up to 2^-53, and there are fewer than 16 roundings after them.
ROUNDING = 2.0**-48
UNDERFLOW = 1e-290

Boxes = tuple[FloatArray, FloatArray]  # least and largest coordinates, each (k, 3)


class FloatingSieve:
    """The pairs on a leg that the checker must decide: what it asks instead of `checker.Nearby`."""

    def __init__(self, triangles: Sequence[Points]) -> None:
        self.corners = np.array(triangles, dtype=np.float64).reshape(-1, 3, 3)
        self._last: tuple[Points, FloatArray] = [], np.empty((0, 3))  # each leg begins where the one before ends

    @staticmethod
    def _array(points: Points) -> FloatArray:
        return np.fromiter(chain.from_iterable(points), np.float64).reshape(len(points), -1)

    def __call__(self, start: Points, end: Points, polygons: Polygons, clearance: float) -> Iterator[tuple[int, ...]]:
        """Yield x₀, x₁, y₀, y₁ of pairs of edges, and x₀, x₁ and the triangle's number; see `checker.Nearby`."""
        if self._last[0] is not start:
            self._last = start, self._array(start)
        before = self._last[1]
        if end is not start:
            self._last = end, self._array(end)
        after, heads = self._last[1], np.array(polygons.heads)
        edges = doubtful_pairs(before, after, heads, clearance)
        for batch in chain(edges, self.doubtful_triangles(before, after, heads, clearance)):
            yield from zip(*batch.tolist(), strict=True)

    def doubtful_triangles(
        self, start: FloatArray, end: FloatArray, heads: IntArray, clearance: float = 0.0
    ) -> Iterator[IntArray]:
        """Yield the edges and triangles that are not proved apart while vertices go from start to end.

        Parameters are those of `doubtful_pairs`. Yields x₀, x₁ and the triangle for a bounded number of pairs, shape
        (3, pairs).
        """
        if not len(self.corners):
            return
        n = len(start)
        still = self.corners.reshape(-1, 3)
        before, after, gap = _scaled(np.concatenate([start, still]), np.concatenate([end, still]), clearance)
        ends = np.stack([start, end, start[heads], end[heads]])
        low, high = ends.min(axis=0) - 4 * clearance, ends.max(axis=0) + 4 * clearance
        triangles = self.corners.min(axis=1), self.corners.max(axis=1)
        # runs of neighbouring edges, whose own box, made without rounding, overlaps all that theirs do, come first
        size = 16
        starts = np.arange(0, n, size)
        runs = np.minimum.reduceat(low, starts), np.maximum.reduceat(high, starts)
        for run, j in overlapping(runs, triangles):
            i, j = (size * run + np.arange(size)[:, None]).ravel(), np.tile(j, size)
            i, j = _really_overlapping((low, high), triangles, i[i < n], j[i < n])
            leg = Leg(before, after, np.stack([i, heads[i], *(n + 3 * j + k for k in range(3))]), gap)
            leg.drop(leg.apart_along_axis)
            leg.drop(leg.apart_by_planes)
            if leg.vertices.size:
                yield np.stack([*leg.vertices[:2], (leg.vertices[2] - n) // 3])


def overlapping(first: Boxes, second: Boxes) -> Iterator[tuple[IntArray, IntArray]]:
    """Yield pairs of overlapping boxes of two kinds in batches: along the widest axis one begins within the other."""
    axis = int(np.argmax(np.ptp(np.concatenate([first[0], second[0]]), axis=0)))
    ranges = [(low[:, axis], high[:, axis]) for low, high in (first, second)]
    of_second = _beginning_within(*ranges[0], ranges[1][0], "left")
    of_first = ((i, j) for j, i in _beginning_within(*ranges[1], ranges[0][0], "right"))
    for i, j in chain(of_second, of_first):
        yield _really_overlapping(first, second, i, j)


def _really_overlapping(first: Boxes, second: Boxes, i: IntArray, j: IntArray) -> tuple[IntArray, IntArray]:
    for axis in range(3):
        keep = (first[0][i, axis] <= second[1][j, axis]) & (second[0][j, axis] <= first[1][i, axis])
        i, j = i[keep], j[keep]
    return i, j


def _beginning_within(
    low: FloatArray, high: FloatArray, begin: FloatArray, side: Literal["left", "right"]
) -> Iterator[tuple[IntArray, IntArray]]:
    """Pairs of a range and another that begins in it; for ``side`` right not at its own beginning."""
    order, at_once = np.argsort(begin, kind="stable"), 1 << 12
    first = np.searchsorted(begin[order], low, side=side)
    total = np.cumsum([0, *np.maximum(np.searchsorted(begin[order], high, side="right") - first, 0)])
    for k in range(0, int(total[-1]), at_once):
        position = np.arange(k, min(k + at_once, int(total[-1])))
        i = np.searchsorted(total, position, side="right") - 1
        yield i, order[first[i] + position - total[i]]


def doubtful_pairs(start: FloatArray, end: FloatArray, heads: IntArray, clearance: float = 0.0) -> Iterator[IntArray]:
    """Yield the pairs of edges that are not proved apart while vertices go from start to end.

    Non-neighbour edges; in triangles, which have none of these, each vertex, as an edge of no length, with the
    opposite edge; and each end of an open polygon with the edge after its neighbour.  Start and end are vertices, shape
    (n, m) with m = 2 or 3; ``heads``, shape (n,), is the vertex that the edge from each vertex leads to: the vertex
    itself where an open polygon ends.  Pairs stay apart even if every coordinate of every vertex is wrong by the
    clearance.

    Yields the vertices x₀, x₁, y₀, y₁ of a bounded number of pairs; shape (4, pairs).
    """
    start, end, clearance = _scaled(start, end, clearance)
    for vertices in chain([_extra_pairs(heads)], _overlapping_edges(start, end, heads, clearance)):
        leg = Leg(start, end, vertices, clearance)
        # Cheap tests first; each looks only at what the one before has left over.
        leg.drop(leg.apart_along_axis)
        leg.drop(leg.apart_by_planes)
        if clearance == 0.0:
            leg.drop(leg.nowhere_coplanar)
        if leg.vertices.size:
            yield leg.vertices


def _scaled(start: FloatArray, end: FloatArray, clearance: float) -> tuple[FloatArray, FloatArray, float]:
    """The same in units in which coordinates are at most 1 in size."""
    exponent = -int(np.frexp(max(np.abs(start).max(), np.abs(end).max()))[1])
    if clearance:
        clearance = max(float(np.ldexp(clearance, exponent)), UNDERFLOW)
    return np.ldexp(start, exponent), np.ldexp(end, exponent), clearance


def _extra_pairs(heads: IntArray) -> IntArray:
    """What must not meet although it is neighbours; shape (4, pairs).

    Each vertex of a triangle, twice, and the ends of the opposite edge; each end of an open polygon, twice, and the two
    vertices after it, the same one if it is the last.
    """
    here = np.arange(len(heads))
    before, goes_on = here.copy(), heads != here
    before[heads[goes_on]] = here[goes_on]
    pairs = [(np.flatnonzero((heads[heads[heads]] == here) & goes_on), heads)]
    pairs += [(np.flatnonzero(before == here), heads), (np.flatnonzero(heads == here), before)]
    return np.concatenate([np.stack([k, k, way[k], way[way[k]]]) for k, way in pairs], axis=1)


def _overlapping_edges(start: FloatArray, end: FloatArray, heads: IntArray, clearance: float) -> Iterator[IntArray]:
    """Non-neighbour edges whose ranges of coordinates during the leg overlap; shapes (4, pairs).

    Ranges are compared and never divided, and rounding keeps the order of values scaled or lowered: no overlapping pair
    is taken to be apart.
    """
    tails = np.flatnonzero(heads != np.arange(len(heads)))
    ends = np.stack([start[tails], end[tails], start[heads[tails]], end[heads[tails]]])
    low, high = ends.min(axis=0) - 4 * clearance, ends.max(axis=0)
    low, high = (np.roll(x, -int(np.ptp(low, axis=0).argmax()), axis=1) for x in (low, high))  # the widest axis first
    order = np.argsort(low[:, 0], kind="stable")
    # In this order edge k overlaps those after it that begin before it ends.
    count = np.searchsorted(low[order, 0], high[order, 0], side="right") - np.arange(len(order)) - 1
    count = np.maximum(count, 0)
    total = np.concatenate([[0], np.cumsum(count)])
    at_once = 1 << 14
    for first in range(0, int(total[-1]), at_once):
        position = np.arange(first, min(first + at_once, int(total[-1])))
        k = np.searchsorted(total, position, side="right") - 1
        i, j = order[k], order[k + 1 + position - total[k]]
        for x, y in zip(low.T[1:], high.T[1:], strict=True):  # the other axes
            keep = (x[i] <= y[j]) & (x[j] <= y[i])
            i, j = i[keep], j[keep]
        i, j = tails[i], tails[j]
        keep = (heads[i] != j) & (heads[j] != i)
        i, j = i[keep], j[keep]
        yield np.stack([i, heads[i], j, heads[j]])


class Leg:
    """Pairs of an edge x₀x₁ and an edge y₀y₁, or a triangle y₀y₁y₂, during one leg, and ways to prove them apart.

    Start and end, shape (n, m), have entries of at most 1 in size; ``vertices``, shape (4 or 5, pairs), are x₀, x₁, y₀,
    y₁, and y₂ of triangles.
    """

    def __init__(self, start: FloatArray, end: FloatArray, vertices: IntArray, clearance: float) -> None:
        self.vertices, self.clearance = vertices, clearance
        ends = np.stack([start, end])[:, vertices].swapaxes(0, 1)  # (4 or 5, 2, pairs, m)
        x, y = ends[:2], ends[2:]
        # x_i − y_j at both times: shape (2, 4 or 6, pairs, m); the vectors of x's edge, and of y's one or three
        self.corners = np.stack([p - q for p in x for q in y], axis=1)
        self.edges = np.stack([x[1] - x[0], *(q - p for p, q in combinations(y, 2))], axis=1)
        self._normals = SEGMENT_NORMALS if len(y) == 2 else TRIANGLE_NORMALS

    def drop(self, proved: Callable[[], BoolArray]) -> None:
        if self.vertices.size:
            left = ~proved()
            self.vertices = self.vertices[:, left]
            self.corners, self.edges = self.corners[:, :, left], self.edges[:, :, left]

    def apart_along_axis(self) -> BoolArray:
        """Whether one edge stays above the other along a coordinate axis."""
        gap = 2.5 * self.clearance
        above = (self.corners > gap).all(axis=(0, 1)) | (self.corners < -gap).all(axis=(0, 1))
        return np.asarray(np.any(above, axis=1))

    def apart_by_planes(self) -> BoolArray:
        """Whether fixed planes separate the edges, each for a part of the time."""
        proved = np.ones(self.vertices.shape[1], dtype=bool)
        self._plane_parts(np.arange(len(proved)), 0.0, 1.0, 5, proved)
        return proved

    def _plane_parts(self, which: IntArray, a: float, b: float, halvings: int, proved: BoolArray) -> None:
        """Prove pairs apart during [a, b], halving it where no plane is found; mark those that fail."""
        middle = 0.5 * (a + b)
        for normal in self._normals:
            if not which.size:
                return
            corners, edges = self.corners[:, :, which], self.edges[:, :, which]
            direction = normal(*((1 - middle) * x[0] + middle * x[1] for x in (corners, edges)))
            which = which[~self._separates(direction, corners, a, b)]
        if halvings and which.size:
            self._plane_parts(which, a, middle, halvings - 1, proved)
            self._plane_parts(which[proved[which]], middle, b, halvings - 1, proved)
        else:
            proved[which] = False

    def _separates(self, direction: FloatArray, corners: FloatArray, a: float, b: float) -> BoolArray:
        """Whether ⟨n, x_i − y_j⟩, linear in time, is certainly positive at times a and b for all corners."""
        value = np.einsum("tcpm,pm->tcp", corners, direction)
        error = ROUNDING * np.einsum("tcpm,pm->tcp", np.abs(corners), np.abs(direction))
        value -= error + (2.5 * self.clearance * np.abs(direction).sum(axis=1) + UNDERFLOW)
        return np.asarray(np.all([((1 - t) * value[0] + t * value[1] > 0).all(axis=0) for t in (a, b)], axis=0))

    def nowhere_coplanar(self) -> BoolArray:
        """Whether det(D, e, f) has no zero in [0, 1]: all its Bernstein coefficients have one sign."""
        if self.corners.shape[-1] == 2:
            return np.zeros(self.vertices.shape[1], dtype=bool)
        vectors = [np.stack([self.corners[t, 0], *self.edges[t]]) for t in (0, 1)]
        sums, errors = np.zeros((4, self.vertices.shape[1])), np.full((4, self.vertices.shape[1]), UNDERFLOW)
        for p in (0, 1):
            for q in (0, 1):
                for r in (0, 1):
                    D, e, f = vectors[p][0], vectors[q][1], vectors[r][2]
                    sums[p + q + r] += np.einsum("pm,pm->p", D, np.cross(e, f))
                    errors[p + q + r] += ROUNDING * _permanent(np.abs(D), np.abs(e), np.abs(f))
        return np.asarray((sums > errors).all(axis=0) | (sums < -errors).all(axis=0))


def _permanent(u: FloatArray, v: FloatArray, w: FloatArray) -> FloatArray:
    following, last = [1, 2, 0], [2, 0, 1]
    products = v[:, following] * w[:, last] + v[:, last] * w[:, following]
    return np.asarray(np.einsum("pm,pm->p", u, products))


Normal = Callable[[FloatArray, FloatArray], FloatArray]


def _chord(corners: FloatArray, edges: FloatArray) -> FloatArray:
    return np.asarray(corners.sum(axis=0))


def _across(first: int, second: int) -> Normal:
    """± the vector product of two edges, pointing from y to x; in the plane there is none."""

    def direction(corners: FloatArray, edges: FloatArray) -> FloatArray:
        if corners.shape[-1] == 2:
            return np.zeros_like(corners[0])
        normal = np.cross(edges[first], edges[second])
        return np.asarray(normal * np.sign(np.einsum("pm,pm->p", normal, corners.sum(axis=0)))[:, None])

    return direction


def _from_line(corner: int, edge: int) -> Normal:
    """From the other edge's line to an end."""

    def direction(corners: FloatArray, edges: FloatArray) -> FloatArray:
        c, e = corners[corner], edges[edge]
        along = np.einsum("pm,pm->p", c, e) / np.maximum(np.einsum("pm,pm->p", e, e), np.finfo(np.float64).tiny)
        return np.asarray(c - along[:, None] * e)

    return direction


def _from_end(corner: int) -> Normal:
    return lambda corners, edges: corners[corner]


SEGMENT_NORMALS: tuple[Normal, ...] = (
    _chord,
    _across(0, 1),
    *(_from_line(corner, edge) for corner, edge in ((0, 1), (2, 1), (0, 0), (1, 0))),
    *(_from_end(corner) for corner in range(4)),
)
# corners x₀y₀, x₀y₁, x₀y₂, x₁y₀, x₁y₁, x₁y₂; edges e, y₁ − y₀, y₂ − y₀, y₂ − y₁
TRIANGLE_NORMALS: tuple[Normal, ...] = (
    _across(1, 2),
    _chord,
    *(_across(0, edge) for edge in (1, 2, 3)),
    *(_from_line(corner, edge) for corner, edge in ((0, 1), (0, 2), (1, 3), (3, 1), (3, 2), (4, 3))),
    *(_from_line(corner, 0) for corner in range(3)),
    *(_from_end(corner) for corner in range(6)),
)
