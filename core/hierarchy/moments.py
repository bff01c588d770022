"""Moments of clusters, collected up the tree, and their derivatives, handed down it again."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..energies.moebius_pairs import DerivativeSums, Vectors
from ..types import FloatArray, IntArray
from .clusters import ClusterTree
from .polynomials import Polynomials

CHUNK = 512  # polynomials handled at once, for the processor's cache


class Moments(NamedTuple):
    """Two polynomials for each cluster, about its centre; or the derivatives of an energy with respect to them.

    Attributes
    ----------
    lengths
        Σ_I ℓ_I exp⟨u_I, ξ⟩ up to degree p, u_I = m_I − centre; shape (clusters, monomials).
    edges
        Σ_I ⟨e_I, ξ⟩ exp⟨u_I, ξ⟩ up to degree p + 1.
    """

    lengths: FloatArray
    edges: FloatArray

    def of(self, clusters: IntArray) -> tuple[FloatArray, FloatArray]:
        """Those of some clusters as polynomials, shape (monomials, k)."""
        lengths, edges = (np.ascontiguousarray(np.take(array, clusters, axis=0).T) for array in self)
        return lengths, edges


class _Leaves(NamedTuple):
    """Consecutive leaves and their edges."""

    clusters: IntArray
    start: IntArray  # of each leaf among the positions
    positions: slice
    edges: IntArray  # at the positions
    leaf_of: IntArray  # of each of them


@dataclass(frozen=True, eq=False)
class MomentTree:
    """The clusters of a curve with their centres, the means of their edges' midpoints.

    Parameters
    ----------
    tree
        The clusters.
    table
        Polynomials of degree p + 1 at least.
    order
        p, the order of the expansions.
    vectors
        Edge vectors, lengths and midpoints.
    """

    tree: ClusterTree
    table: Polynomials
    order: int
    vectors: Vectors

    def zeros(self) -> Moments:
        """Moments to be added to."""
        sizes = self.table.size(self.order), self.table.size(self.order + 1)
        return Moments(*(np.zeros((self.tree.size, size)) for size in sizes))

    @cached_property
    def centres(self) -> FloatArray:
        """Shape (clusters, m)."""
        total = np.empty((self.tree.size, self.vectors.m.shape[1]))
        leaves = self.tree.leaves()
        total[leaves] = np.add.reduceat(self.vectors.m[self.tree.order], self.tree.start[leaves])
        for inner, child in self.tree.upward():
            total[inner] = total[child] + total[child + 1]
        return np.asarray(total / (self.tree.stop - self.tree.start)[:, None])

    def moments(self) -> Moments:
        """The moments of all clusters."""
        moments, table, p = self.zeros(), self.table, self.order
        for leaves in self._leaves():
            power, e = self._powers(leaves), self._edge_polynomials(leaves)
            start = leaves.start - leaves.positions.start
            lengths = self.vectors.ell[leaves.edges] * power
            edges = table.multiply(e, power, p + 1)
            moments.lengths[leaves.clusters] = np.add.reduceat(lengths, start, axis=1).T
            moments.edges[leaves.clusters] = np.add.reduceat(edges, start, axis=1).T
        for parents, children in self._links(self.tree.upward()):
            shift = self._shifts(parents, children)
            for array, own, degree in zip(moments, moments.of(children), (p, p + 1), strict=True):
                array[parents] += table.multiply(own, shift, degree).T
        return moments

    def hand_down(self, local: Moments, pull: FloatArray) -> DerivativeSums:
        """Derivatives with respect to edge vectors, midpoints and lengths.

        From those with respect to the moments at fixed centres and to the centres, ``pull``, shape (clusters, m).
        Both are overwritten.
        """
        table, p = self.table, self.order
        pull /= (self.tree.stop - self.tree.start)[:, None]
        for parents, children in self._links(self.tree.downward()):
            shift = self._shifts(parents, children)
            pull[children] += pull[parents]
            for array, own, lowest in zip(local, local.of(parents), (0, 1), strict=True):
                degrees = range(lowest, p + lowest + 1)
                array[children] += table.contract(own, shift, degrees, degrees).T
        sums = DerivativeSums.zeros(*self.vectors.e.shape)
        for leaves in self._leaves():
            by_edge, by_midpoint, by_length = self._at_edges(leaves, *local.of(leaves.leaf_of))
            sums.by_edge[leaves.edges] = by_edge.T
            sums.by_midpoint[leaves.edges] = by_midpoint.T + pull[leaves.leaf_of]
            sums.by_length[leaves.edges] = by_length
        return sums

    def _at_edges(
        self, leaves: _Leaves, lengths: FloatArray, edges: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """The same at some edges, from the local polynomials of their leaves; shapes (m, k), (m, k) and (k,)."""
        table, p, power = self.table, self.order, self._powers(leaves)
        by_length = table.contract(lengths, power, range(2), range(p + 1))
        by_edge = table.contract(edges, power, range(1, 3), range(1, p + 2))
        along = table.contract(by_edge, self._edge_polynomials(leaves), range(1, 2), range(2, 3))
        by_midpoint = self.vectors.ell[leaves.edges] * by_length[1:] + along[1:]
        return by_edge[1 : len(by_midpoint) + 1], by_midpoint, by_length[0]

    def _edge_polynomials(self, leaves: _Leaves) -> FloatArray:
        """⟨e_I, ξ⟩; shape (m + 1, k)."""
        e = self.vectors.e[leaves.edges].T
        return np.concatenate([np.zeros((1, e.shape[1])), e])

    def _powers(self, leaves: _Leaves) -> FloatArray:
        """exp⟨u_I, ξ⟩ about the centres of the leaves, up to degree p; shape (monomials, k)."""
        u = self.vectors.m[leaves.edges] - self.centres[leaves.leaf_of]
        return self.table.exponentials(u.T, self.order)

    def _shifts(self, parents: IntArray, children: IntArray) -> FloatArray:
        """exp⟨h, ξ⟩ for h from the parents' centres to the children's; shape (monomials, k)."""
        return self.table.exponentials((self.centres[children] - self.centres[parents]).T, self.order)

    def _leaves(self) -> Iterator[_Leaves]:
        """All leaves, some at a time."""
        leaves = self.tree.leaves()
        for first in range(0, len(leaves), CHUNK // 4):
            own = leaves[first : first + CHUNK // 4]
            start, stop = self.tree.start[own], self.tree.stop[own]
            positions = slice(int(start[0]), int(stop[-1]))
            yield _Leaves(own, start, positions, self.tree.order[positions], np.repeat(own, stop - start))

    def _links(self, levels: Iterable[tuple[IntArray, IntArray]]) -> Iterator[tuple[IntArray, IntArray]]:
        """Parents with one child of each, level by level, some at a time."""
        for inner, child in levels:
            for first in range(0, len(inner), CHUNK):
                parents, children = inner[first : first + CHUNK], child[first : first + CHUNK]
                yield parents, children
                yield parents, children + 1
