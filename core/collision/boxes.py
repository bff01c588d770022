"""A tree of moving boxes over the edges: which edges can come near each other, and when."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..curve import Mesh
from ..curve.ordering import component_order
from ..types import BoolArray, FloatArray, IntArray

CHUNK = 1 << 14  # pairs of boxes handled at once: bounds the memory whatever the curve
_ROOTS = 24  # the coarsest level has at most this many boxes; above it a tree only costs calls
_NOWHERE = -4.0  # upper bounds of a padding box: empty, and away from everything when coordinates are at most 1
_SLACK = 16 * float(np.finfo(np.float64).eps)

Test = Callable[["Level", IntArray, IntArray], BoolArray]


@dataclass(frozen=True, eq=False)
class Level:
    """Boxes of one level at the start and at the end of a leg.

    Attributes
    ----------
    upper, flipped
        Shape (2, 2m, boxes): at the two times, the upper bounds of (x, −x), and of (−x, x). A vertex that moves
        linearly from one box to the other is at time t in the box interpolated between them.
    leaves
        Whether a box holds a single edge.
    """

    upper: FloatArray
    flipped: FloatArray
    leaves: bool

    def gaps(self, a: IntArray, b: IntArray) -> FloatArray:
        """Signed gaps between boxes ``a`` and ``b`` along ±each axis at both times; shape (2, 2m, pairs)."""
        gaps = self.upper.take(a, axis=2)
        gaps += self.flipped.take(b, axis=2)
        return np.asarray(np.negative(gaps, out=gaps))


@dataclass(frozen=True, eq=False)
class BoxTree:
    """Boxes over contiguous ranges of edges in curve order, halved from level to level.

    Attributes
    ----------
    mesh
        Connectivity.
    order
        Edge at each position of the finest level; components near each other in space come next to each other.
    levels
        From the coarsest to single edges.
    """

    mesh: Mesh
    order: IntArray
    levels: tuple[Level, ...]

    @classmethod
    def build(cls, mesh: Mesh, start: FloatArray, end: FloatArray) -> "BoxTree":
        """Build the tree of one leg; ``start`` and ``end`` have shape (m, n) and entries of at most 1 in size."""
        order = component_order(mesh, start)
        points = np.stack([start, end])
        tails, heads = points[..., mesh.tails[order]], points[..., mesh.heads[order]]
        upper = np.concatenate([np.maximum(tails, heads), -np.minimum(tails, heads)], axis=1)
        upper = _padded(upper)
        levels = [_level(upper, leaves=True)]
        while upper.shape[2] > _ROOTS:
            upper = _padded(np.maximum(upper[..., 0::2], upper[..., 1::2]))
            levels.append(_level(upper, leaves=False))
        return cls(mesh, order, tuple(reversed(levels)))

    def pairs(self, near: Test) -> Iterator[tuple[IntArray, IntArray]]:
        """Yield all pairs of non-neighbour edges whose boxes, and all boxes above them, pass the test ``near``.

        ``near`` gets a level and two arrays of box indices and returns which pairs to keep. Every pair of edges is
        met at most once. Edges are yielded as two arrays of positions in ``order``, about ``CHUNK`` pairs at a time.
        """
        a, b = np.triu_indices(self.levels[0].upper.shape[2])
        stack = [(0, a, b)]
        while stack:
            depth, a, b = stack.pop()
            level = self.levels[depth]
            keep = near(level, a, b)
            a, b = a[keep], b[keep]
            if level.leaves:
                yield self._strangers(a, b)
                continue
            a, b = _children(a, b)
            # The last part is taken up first, so the stack stays short: depth first in chunks.
            stack += [(depth + 1, a[k : k + CHUNK], b[k : k + CHUNK]) for k in range(0, len(a), CHUNK)]

    @cached_property
    def _ends(self) -> IntArray:
        """The vertices of the edge at each position; shape (2, edges)."""
        return np.stack([self.mesh.tails, self.mesh.heads])[:, self.order]

    def corners(self, a: IntArray, b: IntArray) -> IntArray:
        """The vertices x₀, x₁, y₀, y₁ of the edges at positions ``a`` and ``b``; shape (4, pairs)."""
        tails, heads = self._ends
        return np.stack([tails[a], heads[a], tails[b], heads[b]])

    def _strangers(self, a: IntArray, b: IntArray) -> tuple[IntArray, IntArray]:
        """Drop padding, equal and neighbouring edges from pairs of positions."""
        real = b < len(self.order)
        a, b = a[real], b[real]
        tails, heads = self._ends
        apart = (a != b) & (heads[a] != tails[b]) & (heads[b] != tails[a])
        return a[apart], b[apart]


def corners(mesh: Mesh, i: IntArray | int, j: IntArray | int) -> IntArray:
    """The vertices x₀, x₁, y₀, y₁ of edges ``i`` and ``j``; shape (4, pairs), or (4,) of one pair."""
    return np.stack([mesh.tails[i], mesh.heads[i], mesh.tails[j], mesh.heads[j]])


def contact_window(gaps: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the times between which moving boxes can overlap, each of shape (pairs,); empty if first > second.

    ``gaps`` are the signed gaps of `Level.gaps`. They are linear in time, and boxes overlap only while none is
    positive. Rounding makes the window wider, never narrower.
    """
    before, after = gaps
    with np.errstate(divide="ignore", invalid="ignore"):
        root = before / (before - after)  # signs differ where it is used: accurate to a few eps
    enter = np.where(before > 0, np.where(after > 0, np.inf, root), 0.0).max(axis=0)
    leave = np.where((before <= 0) & (after > 0), root, 1.0).min(axis=0)
    return enter * (1 - _SLACK), leave * (1 + _SLACK)


def _level(upper: FloatArray, leaves: bool) -> Level:
    m = upper.shape[1] // 2
    return Level(upper, np.concatenate([upper[:, m:], upper[:, :m]], axis=1), leaves)


def _padded(upper: FloatArray) -> FloatArray:
    """Boxes with an empty one added if their number is odd, so that they merge two by two."""
    if upper.shape[2] % 2 == 0:
        return upper
    return np.concatenate([upper, np.full((*upper.shape[:2], 1), _NOWHERE)], axis=2)


def _children(a: IntArray, b: IntArray) -> tuple[IntArray, IntArray]:
    """Pairs of halves of each pair of boxes, every unordered pair once."""
    left = (2 * a + np.array([[0], [0], [1], [1]])).ravel()
    right = (2 * b + np.array([[0], [1], [0], [1]])).ravel()
    once = left <= right
    return left[once], right[once]
