"""Trees of boxes over moving edges and triangles at rest: which of them can come near each other, and when.

These trees are complete, unlike `ClusterTree`: children need no table and all leaves are on one level.  Otherwise a
search of a few milliseconds would spend a good part of them on finding out which nodes are leaves.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

import numpy as np

from ..base import PLANE_UNDERFLOW, BoolArray, FloatArray, IntArray
from ..curve import Mesh, Obstacle, component_order, near_to_near

_HALVES = {  # numbers of the halves of the first and of the second box, if they are halved
    (halved, also): np.array([(k, j) for k in range(1 + halved) for j in range(1 + also)]).T[:, :, None]
    for halved in (False, True)
    for also in (False, True)
}

Test = Callable[["Level", IntArray, "Level", IntArray], BoolArray]


@dataclass(frozen=True, eq=False)
class Level:
    """Boxes of one level at the start and at the end of a leg.

    A vertex that moves linearly from one box to the other is at time t in the box interpolated between them.  Boxes
    that stand still may have shape (1, 2m, boxes).
    """

    upper: FloatArray  # upper bounds of (x, −x) at the two times; shape (2, 2m, boxes)
    flipped: FloatArray  # the same for (−x, x)
    leaves: bool  # whether a box holds a single simplex

    @classmethod
    def of(cls, upper: FloatArray, leaves: bool) -> "Level":
        return cls(upper, np.roll(upper, upper.shape[1] // 2, axis=1), leaves)

    def gaps(self, a: IntArray, other: "Level", b: IntArray) -> FloatArray:
        """Signed gaps from moving boxes ``a`` to boxes ``b`` of another level, ± each axis; shape (2, 2m, pairs)."""
        gaps = self.upper.take(a, axis=2)
        gaps += other.flipped.take(b, axis=2)
        return np.asarray(np.negative(gaps, out=gaps))


@dataclass(frozen=True, eq=False)
class BoxTree:
    """Boxes over contiguous ranges of simplices, ordered so that neighbours are near, halved level by level."""

    order: IntArray  # edge, or triangle, at each position of the finest level; shape (k,)
    corners: IntArray  # vertices of the simplex at each position; shape (2, k) for edges, (3, k) for triangles
    levels: tuple[Level, ...]  # from the coarsest to single simplices
    chunk: ClassVar[int] = 1 << 14  # pairs of boxes handled at once: bounds the memory whatever the curve

    @classmethod
    def build(cls, mesh: Mesh, *points: FloatArray) -> "BoxTree":
        """The tree of a leg from start to end, or of a curve at rest; entries, (m, n), of absolute value at most 1."""
        order = component_order(mesh, points[0])
        return cls.over(order, np.stack([mesh.tails[order], mesh.heads[order]]), np.stack(points))

    @classmethod
    def over(cls, order: IntArray, corners: IntArray, points: FloatArray) -> "BoxTree":
        """A tree over simplices; ``points``, shape (2 or 1, m, n), are all vertices at both times, or at all times.

        Boxes are wider than their contents by an amount that matters only where scaling has cost digits.
        """
        ends = [points[..., vertices] for vertices in corners]
        upper = _padded(np.concatenate([np.maximum.reduce(ends), -np.minimum.reduce(ends)], axis=1) + PLANE_UNDERFLOW)
        levels = [Level.of(upper, leaves=True)]
        while upper.shape[2] > 24:  # levels above that would only cost calls
            upper = _padded(np.maximum(upper[..., 0::2], upper[..., 1::2]))
            levels.append(Level.of(upper, leaves=False))
        return cls(order, corners, tuple(reversed(levels)))

    def pairs(self, near: Test) -> Iterator[tuple[IntArray, IntArray]]:
        """`pairs_with` itself: each pair of edges once, except pairs that share a vertex."""
        for a, b in self.pairs_with(self, near):
            common = [p[a] == q[b] for p in self.corners for q in self.corners]
            apart = ~np.logical_or.reduce(common)
            yield a[apart], b[apart]

    def pairs_with(self, other: "BoxTree", near: Test) -> Iterator[tuple[IntArray, IntArray]]:
        """Yield all pairs of simplices of two trees whose boxes, and all boxes above them, pass the test ``near``.

        ``near`` gets two levels, each with an array of boxes, and returns which pairs to keep. Simplices are yielded as
        two arrays of positions in either ``order``, about a ``chunk`` of pairs at a time.
        """
        a, b = np.indices((self.levels[0].upper.shape[2], other.levels[0].upper.shape[2])).reshape(2, -1)
        stack = [(0, 0, a, b)]
        while stack:
            p, q, a, b = stack.pop()
            one, two = self.levels[p], other.levels[q]
            if self is other:
                a, b = a[a <= b], b[a <= b]
            keep = near(one, a, two, b)
            a, b = a[keep], b[keep]
            if one.leaves and two.leaves:
                real = (a < len(self.order)) & (b < len(other.order))
                yield a[real], b[real]
                continue
            # The tree with more levels left is halved, or both are, so that they reach their leaves together.
            ahead = len(self.levels) - p - len(other.levels) + q
            first, second = ahead >= 0, ahead <= 0
            left, right = _HALVES[first, second]
            a, b = ((1 + first) * a + left).ravel(), ((1 + second) * b + right).ravel()
            p, q = p + first, q + second
            # The last part is taken up first, so the stack stays short: depth first in chunks.
            chunks = ((a[k : k + self.chunk], b[k : k + self.chunk]) for k in range(0, len(a), self.chunk))
            stack += [(p, q, *each) for each in chunks]


def corners(mesh: Mesh, i: IntArray | int, j: IntArray | int) -> IntArray:
    """The vertices x₀, x₁, y₀, y₁ of edges ``i`` and ``j``; shape (4, pairs), or (4,) of one pair."""
    return np.stack([mesh.tails[i], mesh.heads[i], mesh.tails[j], mesh.heads[j]])


def contact_window(gaps: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the times between which moving boxes can overlap, each of shape (pairs,); empty if first > second.

    ``gaps`` are the signed gaps of `Level.gaps`. They are linear in time, and boxes overlap only while none is
    positive. Rounding makes the window wider, never narrower, and the window of boxes contains those of boxes in them:
    bounds of the larger boxes are no smaller, sums, quotients and products are rounded monotonically, and each
    operation below, where its result is used, rises or falls with either gap throughout. So larger gaps never give an
    earlier ``enter`` or a later ``leave``, to the last bit, and a search may be split at any ``enter``. (The usual
    before / (before − after) has its operand twice, and is not monotone when rounded.)
    """
    before, after = gaps
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        root = 1 / (1 - after / before)  # signs differ where it is used: accurate to a few eps
    enter = np.where(before > 0, np.where(after > 0, np.inf, root), 0.0).max(axis=0)
    leave = np.where((before <= 0) & (after > 0), root, 1.0).min(axis=0)
    slack = 16 * np.finfo(np.float64).eps
    return enter * (1 - slack), leave * (1 + slack)


def _padded(upper: FloatArray) -> FloatArray:
    """Boxes with an empty one added if their number is odd, so that they merge in pairs."""
    if upper.shape[2] % 2 == 0:
        return upper
    nowhere = -4.0  # an upper bound of nothing, away from everything when coordinates are at most 1
    return np.concatenate([upper, np.full((*upper.shape[:2], 1), nowhere)], axis=2)


@dataclass(frozen=True, eq=False)
class StillTriangles:
    """The simplices of several obstacles; a segment is a triangle two of whose vertices coincide."""

    obstacles: tuple[Obstacle, ...]
    vertices: FloatArray  # of all obstacles, in the user's units; shape (k, 3)
    tree: BoxTree  # over the triangles in units of two to the power of the exponent

    def obstacle_of(self, triangle: int) -> Obstacle:
        """The obstacle that a triangle, counted over all obstacles, belongs to."""
        ends = np.cumsum([len(each.faces) for each in self.obstacles])
        return self.obstacles[int(np.searchsorted(ends, triangle, side="right"))]


def nearer_than(square: Callable[[], float]) -> Test:
    """The test whether boxes, at the first time, are at most that squared distance apart, which may fall meanwhile.

    Boxes are never further apart than those in them, to the last bit: gaps are not larger, and each product and sum is
    rounded monotonically, in the same order for all pairs.
    """

    def near(level: Level, a: IntArray, other: Level, b: IntArray) -> BoolArray:
        gaps = np.maximum(level.gaps(a, other, b)[0], 0.0)
        return np.asarray(sum(gap * gap for gap in gaps) <= square())

    return near


@lru_cache(maxsize=8)
def still_triangles(obstacles: tuple[Obstacle, ...], exponent: int) -> StillTriangles:
    """The triangles of some obstacles, whose coordinates are at most two to the power of ``exponent``."""
    vertices = np.concatenate([each.vertices for each in obstacles])
    first = np.cumsum([0, *(len(each.vertices) for each in obstacles)])
    numbered = zip(obstacles, first[:-1], strict=True)
    corners = np.concatenate([each.faces[:, [0, 1, -1]] + k for each, k in numbered]).T
    points = np.ldexp(vertices.T, -exponent, order="C")
    order = near_to_near(points[:, corners].mean(axis=1))
    return StillTriangles(obstacles, vertices, BoxTree.over(order, corners[:, order], points[None]))
