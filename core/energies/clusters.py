"""Binary trees of clusters: ranges of positions in an order of edges or simplices, halved down to leaves."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from ..base import BoolArray, FloatArray, IntArray, frozen

Cut = Callable[[IntArray, IntArray], IntArray]
"""Where to cut ranges [start, stop); it may sort the order within them first."""


@dataclass(frozen=True, eq=False)
class ClusterTree:
    """Clusters, numbered level by level from the root."""

    order: IntArray  # what is at each position; shape (k,)
    start: IntArray  # cluster c holds order[start[c]:stop[c]]; shape (clusters,)
    stop: IntArray
    child: IntArray  # the first of a cluster's two children, which are numbered consecutively; 0 for leaves
    levels: tuple[slice, ...]  # the clusters of each level, from the root

    @classmethod
    def halved(cls, order: IntArray, leaf: int, cut: Cut) -> "ClusterTree":
        """The tree over an order whose leaves have at most ``leaf`` members, leaf ≥ 1."""
        start, stop = np.array([0]), np.array([len(order)])
        parts, levels, first = [], [], 0
        while start.size:
            last = first + start.size
            levels.append(slice(first, last))
            split = stop - start > leaf
            child = np.zeros_like(start)
            child[split] = last + 2 * np.arange(np.count_nonzero(split))
            parts.append((start, stop, child))
            start, stop = start[split], stop[split]
            middle = cut(start, stop)
            start, stop = (np.stack(ends, axis=1).ravel() for ends in ((start, middle), (middle, stop)))
            first = last
        starts, stops, children = (frozen(np.concatenate(arrays)) for arrays in zip(*parts, strict=True))
        return cls(order, starts, stops, children, tuple(levels))

    @property
    def size(self) -> int:
        return len(self.start)

    @property
    def is_leaf(self) -> BoolArray:
        """Which clusters have no children; shape (clusters,)."""
        return np.asarray(self.child == 0)

    def leaves(self) -> IntArray:
        """The leaves in the order of their members, so that their ranges follow each other without gaps."""
        leaves = np.flatnonzero(self.is_leaf)
        return leaves[np.argsort(self.start[leaves])]

    def upward(self) -> Iterator[tuple[IntArray, IntArray]]:
        """Yield the inner clusters of each level and their first children, the deepest level first."""
        for level in reversed(self.levels):
            child = self.child[level]
            inner = np.flatnonzero(child)
            yield level.start + inner, child[inner]

    def downward(self) -> Iterator[tuple[IntArray, IntArray]]:
        """The same from the root."""
        yield from reversed(list(self.upward()))

    def reduced(self, function: np.ufunc, values: FloatArray) -> FloatArray:
        """A function of two numbers taken over each cluster; (positions, k) -> (clusters, k)."""
        reduced = np.empty((self.size, *values.shape[1:]))
        leaves = self.leaves()
        reduced[leaves] = function.reduceat(values, self.start[leaves])
        for inner, child in self.upward():
            reduced[inner] = function(reduced[child], reduced[child + 1])
        return reduced


def ranges(start: IntArray, count: IntArray) -> IntArray:
    """start, start + 1, … of each of some ranges, one after the other."""
    return np.asarray(np.repeat(start - np.cumsum(count) + count, count) + np.arange(count.sum()))
