"""The upward and the downward pass: moments of all clusters, and derivatives at the edges from those at the clusters.

In the words of the fast multipole method they are P2M and M2M, and L2L and L2P; what is between is in `fields`.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..clusters import ClusterTree
from ..energies.moebius_pairs import DerivativeSums, Vectors
from ..types import FloatArray, IntArray
from .polynomials import Polynomials, polynomials

CHUNK = 1024  # polynomials handled at once, for the processor's cache


@dataclass(frozen=True)
class Expansion:
    """Taylor expansions of order p about the centre of a cluster: two moments, one below the other in one array.

    With u_I = m_I − centre they are Σ_I ℓ_I exp⟨u_I, ξ⟩ up to degree p and Σ_I ⟨e_I, ξ⟩ exp⟨u_I, ξ⟩ up to degree p + 1.
    Arrays of derivatives with respect to these have rows for those with respect to the centre besides.
    """

    dimension: int  # m, that of space
    order: int  # p

    @property
    def table(self) -> Polynomials:
        """Polynomials of all degrees needed, those of the kernels' derivatives among them."""
        return polynomials(self.dimension, self.order + 3)

    @property
    def lengths(self) -> slice:
        """Rows of the first moment."""
        return slice(0, self.table.size(self.order))

    @property
    def edges(self) -> slice:
        """Rows of the second moment."""
        return slice(self.lengths.stop, self.lengths.stop + self.table.size(self.order + 1))

    @property
    def by_centre(self) -> slice:
        """Rows of derivatives with respect to the centre."""
        return slice(self.edges.stop, self.edges.stop + self.dimension)

    @cached_property
    def signs(self) -> FloatArray:
        """Signs that come with the second cluster of a block, seen from which d is −d; shape (rows,)."""
        signs = self.table.signs[:, 0]
        lengths, edges = signs[: self.table.size(self.order)], -signs[: self.table.size(self.order + 1)]
        return np.concatenate([lengths, edges, np.full(self.dimension, -1.0)])


class _Leaves(NamedTuple):
    """Consecutive leaves and their edges."""

    clusters: IntArray
    start: IntArray  # of each among the edges
    edges: IntArray
    leaf_of: IntArray  # the leaf of each edge


@dataclass(frozen=True, eq=False)
class MomentTree:
    """The clusters of a curve with their centres, the means of their edges' midpoints."""

    tree: ClusterTree
    expansion: Expansion  # what their moments are
    vectors: Vectors  # edge vectors, lengths and midpoints

    @cached_property
    def centres(self) -> FloatArray:
        """Shape (clusters, m)."""
        total = np.empty((self.tree.size, self.vectors.m.shape[1]))
        leaves = self.tree.leaves()
        total[leaves] = np.add.reduceat(self.vectors.m[self.tree.order], self.tree.start[leaves])
        for inner, child in self.tree.upward():
            total[inner] = total[child] + total[child + 1]
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

        ``local``, shape (clusters, rows), are those with respect to the moments at fixed centres and to the centres;
        it is overwritten.
        """
        x = self.expansion
        local[:, x.by_centre] /= (self.tree.stop - self.tree.start)[:, None]
        for parents, children in self._links(self.tree.downward()):
            local[children] += self._moved(polynomial_rows(local, parents), self._shifts(parents, children)).T
        sums = DerivativeSums.zeros(*self.vectors.e.shape)
        for leaves in self._leaves():
            by_edge, by_midpoint, by_length = self._at_edges(leaves, polynomial_rows(local, leaves.leaf_of))
            sums.by_edge[leaves.edges] = by_edge.T
            sums.by_midpoint[leaves.edges] = by_midpoint.T
            sums.by_length[leaves.edges] = by_length
        return sums

    def _moved(self, local: FloatArray, shift: FloatArray) -> FloatArray:
        """Derivatives with respect to the children's moments, from the parents'; shape (rows, k)."""
        x, moved = self.expansion, []
        for lowest, rows in enumerate((x.lengths, x.edges)):
            degrees = range(lowest, x.order + lowest + 1)
            moved.append(x.table.contract(local[rows], shift, degrees, degrees))
        return np.concatenate([*moved, local[x.by_centre]])

    def _at_edges(self, leaves: _Leaves, local: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Derivatives at some edges, from those of their leaves; shapes (m, k), (m, k) and (k,)."""
        x, m, power = self.expansion, self.expansion.dimension, self._powers(leaves)
        contract = x.table.contract
        by_length = contract(local[x.lengths], power, range(2), range(x.order + 1))
        by_edge = contract(local[x.edges], power, range(1, 3), range(1, x.order + 2))
        e = np.concatenate([np.zeros((1, len(leaves.edges))), self.vectors.e[leaves.edges].T])
        by_midpoint = self.vectors.ell[leaves.edges] * by_length[1:] + local[x.by_centre]
        by_midpoint += contract(by_edge, e, range(1, 2), range(2, 3))[1:]
        return by_edge[1 : m + 1], by_midpoint, by_length[0]

    def _powers(self, leaves: _Leaves) -> FloatArray:
        """exp⟨u_I, ξ⟩ about the centres of the leaves, up to degree p; shape (monomials, k)."""
        u = self.vectors.m[leaves.edges] - self.centres[leaves.leaf_of]
        return self.expansion.table.exponentials(u.T, self.expansion.order)

    def _shifts(self, parents: IntArray, children: IntArray) -> FloatArray:
        """exp⟨h, ξ⟩ for h from the parents' centres to the children's; shape (monomials, k)."""
        h = self.centres[children] - self.centres[parents]
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
    """What an array of shape (clusters, rows) has for some of them, contiguous by rows; shape (rows, k)."""
    return np.ascontiguousarray(np.take(array, clusters, axis=0).T)
