"""A binary tree of clusters: ranges of consecutive edges, halved down to leaves."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..curve import Curve, Mesh
from ..curve.ordering import component_order
from ..types import BoolArray, FloatArray, IntArray, frozen


@dataclass(frozen=True, eq=False)
class ClusterTree:
    """Clusters as ranges of positions in an order of the edges, numbered level by level from the root.

    The order follows the curve, one component after the other; only their succession is changed where there are three
    or more, so that neighbours in space come next to each other.  A cluster is a part of one component, or several
    whole ones: however many small components there are, the tree of n edges has O(n) clusters and O(log n) levels.

    Attributes
    ----------
    mesh
        Connectivity.
    order
        Edge at each position; shape (edges,).
    start, stop
        Cluster c holds the edges ``order[start[c]:stop[c]]``; shape (clusters,).
    child
        The first of a cluster's two children, which are numbered one after the other; 0 for leaves.
    levels
        The clusters of each level, from the root.
    """

    mesh: Mesh
    order: IntArray
    start: IntArray
    stop: IntArray
    child: IntArray
    levels: tuple[slice, ...]

    @classmethod
    def of(cls, curve: Curve, leaf: int) -> "ClusterTree":
        """The tree whose leaves have at most ``leaf`` edges; leaf ≥ 1."""
        order = component_order(curve.mesh, curve.vertices.T)
        ends = _component_ends(curve.mesh, order)
        start, stop = np.array([0]), np.array([len(order)])
        parts, levels, first = [], [], 0
        while start.size:
            last = first + start.size
            levels.append(slice(first, last))
            split = stop - start > leaf
            child = np.zeros_like(start)
            child[split] = last + 2 * np.arange(np.count_nonzero(split))
            parts.append((start, stop, child))
            middle = _middle(start[split], stop[split], ends)
            start, stop = _interleaved(start[split], middle), _interleaved(middle, stop[split])
            first = last
        starts, stops, children = (frozen(np.concatenate(arrays)) for arrays in zip(*parts, strict=True))
        return cls(curve.mesh, order, starts, stops, children, tuple(levels))

    @property
    def size(self) -> int:
        """Number of clusters."""
        return len(self.start)

    @property
    def is_leaf(self) -> BoolArray:
        """Which clusters have no children; shape (clusters,)."""
        return np.asarray(self.child == 0)

    def leaves(self) -> IntArray:
        """The leaves in the order of their edges, so that their ranges follow each other without gaps."""
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

    def balls(self, curve: Curve) -> tuple[FloatArray, FloatArray]:
        """Centres, shape (clusters, m), and radii, shape (clusters,), of balls around the clusters' bounding boxes."""
        ends = curve.vertices[curve.mesh.tails[self.order]], curve.vertices[curve.mesh.heads[self.order]]
        low = self._reduced(np.minimum, np.minimum(*ends))
        high = self._reduced(np.maximum, np.maximum(*ends))
        diagonal = high - low
        return 0.5 * (low + high), 0.5 * np.sqrt(np.einsum("ij,ij->i", diagonal, diagonal))

    def _reduced(self, function: np.ufunc, values: FloatArray) -> FloatArray:
        """A function of two numbers taken over all edges of each cluster; from values (edges, k) at the positions."""
        reduced = np.empty((self.size, values.shape[1]))
        leaves = self.leaves()
        reduced[leaves] = function.reduceat(values, self.start[leaves])
        for inner, child in self.upward():
            reduced[inner] = function(reduced[child], reduced[child + 1])
        return reduced


def _component_ends(mesh: Mesh, order: IntArray) -> IntArray:
    """Positions at which components end."""
    return np.append(np.flatnonzero(np.diff(mesh.edge_component[order])) + 1, mesh.edges)


def _middle(start: IntArray, stop: IntArray, ends: IntArray) -> IntArray:
    """Where to cut ranges: between two components if they hold more than one, else in the middle."""
    middle = (start + stop) // 2
    after = np.searchsorted(ends, middle)
    before = ends[np.maximum(after - 1, 0)]
    nearer = (ends[after] >= stop) | (2 * middle < before + ends[after])
    cut = np.where((before > start) & nearer, before, ends[after])
    return np.where((cut > start) & (cut < stop), cut, middle)


def _interleaved(first: IntArray, second: IntArray) -> IntArray:
    return np.stack([first, second], axis=1).ravel()
