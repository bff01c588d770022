"""The upward and the downward pass: moments of all clusters, and derivatives at the edges from those at the clusters.

In the terms of the fast multipole method they are P2M and M2M, and L2L and L2P; the step between is in `fields`.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ...base.types import FloatArray, IntArray
from ..clusters import ClusterTree
from ..moebius_pairs import DerivativeSums, Vectors
from .polynomials import Polynomials, polynomials

CHUNK = 1024  # polynomials processed together, for the processor's cache


class Expansion(NamedTuple):
    """Taylor expansions of order p about the center of a cluster: two moments, one below the other in one array.

    With u_I = m_I − center they are Σ_I ℓ_I exp⟨u_I, ξ⟩ up to degree p and Σ_I ⟨e_I, ξ⟩ exp⟨u_I, ξ⟩ up to degree p + 1.
    Arrays of derivatives with respect to these have further rows for derivatives with respect to the center.
    """

    dimension: int  # m, the dimension of space
    order: int  # p
    table: Polynomials  # of all degrees needed, including those of the kernels' derivatives
    lengths: slice  # rows of the first moment
    edges: slice  # rows of the second moment
    by_center: slice  # rows of derivatives with respect to the center
    signs: FloatArray  # of the second cluster of a block relative to the first, since d becomes −d; shape (rows,)

    @classmethod
    def of(cls, dimension: int, order: int) -> "Expansion":
        """The expansions of an order."""
        table = polynomials(dimension, order + 3)
        a, b, signs = table.size(order), table.size(order) + table.size(order + 1), table.signs[:, 0]
        signs = np.concatenate([signs[:a], -signs[: b - a], np.full(dimension, -1.0)])
        return cls(dimension, order, table, slice(0, a), slice(a, b), slice(b, b + dimension), signs)


class _Leaves(NamedTuple):
    """Consecutive leaves and their edges."""

    clusters: IntArray
    start: IntArray  # first position of each leaf among the edges
    edges: IntArray
    leaf_of: IntArray  # the leaf of each edge


@dataclass(frozen=True, eq=False)
class MomentTree:
    """The clusters of a curve with their centers, the means of their edges' midpoints."""

    tree: ClusterTree
    expansion: Expansion  # the expansions that define their moments
    vectors: Vectors  # edge vectors, lengths and midpoints

    @cached_property
    def centers(self) -> FloatArray:
        """The clusters' centers; shape (clusters, m)."""
        total = self.tree.reduced(np.add, self.vectors.m[self.tree.order])
        return np.asarray(total / (self.tree.stop - self.tree.start)[:, None])

    def moments(self) -> FloatArray:
        """The upward pass: the moments of all clusters; shape (clusters, rows)."""
        x, table = self.expansion, self.expansion.table
        moments = np.zeros((self.tree.size, x.edges.stop))
        for leaves in self._leaves():
            power = self._powers(leaves)
            both = self.vectors.ell[leaves.edges] * power, table.multiply_linear(self.vectors.e[leaves.edges].T, power)
            moments[leaves.clusters] = np.add.reduceat(np.concatenate(both), leaves.start, axis=1).T
        for parents, children in self._links(self.tree.upward()):
            shift, own = self._shifts(parents, children), polynomial_rows(moments, children)
            moved = [table.multiply(own[rows], shift, x.order + k) for k, rows in enumerate((x.lengths, x.edges))]
            moments[parents] += np.concatenate(moved).T
        return moments

    def derivative_sums(self, local: FloatArray) -> DerivativeSums:
        """The downward pass: derivatives with respect to edge vectors, midpoints and lengths.

        ``local``, shape (clusters, rows), are those with respect to the moments at fixed centers and to the centers;
        it is overwritten.
        """
        x = self.expansion
        local[:, x.by_center] /= (self.tree.stop - self.tree.start)[:, None]
        for parents, children in self._links(self.tree.downward()):
            # derivatives with respect to the children's moments, from the parents'
            theirs, shift = polynomial_rows(local, parents), self._shifts(parents, children)
            x, moved = self.expansion, []
            for lowest, rows in enumerate((x.lengths, x.edges)):
                degrees = range(lowest, x.order + lowest + 1)
                moved.append(x.table.contract(theirs[rows], shift, degrees, degrees))
            local[children] += np.concatenate([*moved, theirs[x.by_center]]).T
        sums = DerivativeSums.zeros(self.vectors.e.shape)
        for leaves in self._leaves():
            own = polynomial_rows(local, leaves.leaf_of)
            x, m, power = self.expansion, self.expansion.dimension, self._powers(leaves)
            contract = x.table.contract
            by_length = contract(own[x.lengths], power, range(2), range(x.order + 1))
            by_edge = contract(own[x.edges], power, range(1, 3), range(1, x.order + 2))
            e = np.concatenate([np.zeros((1, len(leaves.edges))), self.vectors.e[leaves.edges].T])
            by_midpoint = self.vectors.ell[leaves.edges] * by_length[1:] + own[x.by_center]
            by_midpoint += contract(by_edge, e, range(1, 2), range(2, 3))[1:]
            by_edge, by_midpoint, by_length = by_edge[1 : m + 1], by_midpoint, by_length[0]
            sums.by_edge[leaves.edges] = by_edge.T
            sums.by_midpoint[leaves.edges] = by_midpoint.T
            sums.by_length[leaves.edges] = by_length
        return sums

    def _powers(self, leaves: _Leaves) -> FloatArray:
        """exp⟨u_I, ξ⟩ about the centers of the leaves, up to degree p; shape (monomials, k)."""
        u = self.vectors.m[leaves.edges] - self.centers[leaves.leaf_of]
        return self.expansion.table.exponentials(u.T, self.expansion.order)

    def _shifts(self, parents: IntArray, children: IntArray) -> FloatArray:
        """exp⟨h, ξ⟩ for h from the parents' centers to the children's; shape (monomials, k)."""
        h = self.centers[children] - self.centers[parents]
        return self.expansion.table.exponentials(h.T, self.expansion.order)

    def _leaves(self) -> Iterator[_Leaves]:
        """All leaves, some at a time."""
        leaves = self.tree.leaves()
        step = max(1, CHUNK * len(leaves) // len(self.tree.order))
        for first in range(0, len(leaves), step):
            own = leaves[first : first + step]
            start, stop = self.tree.start[own], self.tree.stop[own]
            yield _Leaves(own, start - start[0], self.tree.order[start[0] : stop[-1]], np.repeat(own, stop - start))

    def _links(self, levels: Iterable[tuple[IntArray, IntArray]]) -> Iterator[tuple[IntArray, IntArray]]:
        """Parents with one child of each, level by level, some at a time."""
        for inner, child in levels:
            for first in range(0, len(inner), CHUNK):
                parents, children = inner[first : first + CHUNK], child[first : first + CHUNK]
                yield parents, children
                yield parents, children + 1


def polynomial_rows(array: FloatArray, clusters: IntArray) -> FloatArray:
    """The entries for some clusters of an array of shape (clusters, rows), contiguous by rows; shape (rows, k)."""
    return np.ascontiguousarray(np.take(array, clusters, axis=0).T)
