"""The Möbius energy of near pairs one by one, and of blocks by Taylor expansion about the centers of their clusters.

With G = log|Δ| the contribution of a pair of edges is W_IJ = ℓ_I ℓ_J/|Δ|² + ⟨e_I, ∇⟩⟨e_J, ∇⟩ G: sums over a block are
products of two moments applied to two kernels, both up to the same order, so that errors cancel on straight pieces.
The derivative is exactly that of the value.
"""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

from ...base import FloatArray, IntArray
from ...base import column_dot as dot
from ..edge_pairs import EdgePairIndices
from ..moebius import EdgeDerivatives, Edges, Pairs, PartnerSums
from .blocks import BlockList
from .polynomials import kernel_derivatives, polynomials

CHUNK, PAIRS = 1024, 8192  # blocks, clusters or edges, and near pairs, processed together, for the processor's cache


class NearField(NamedTuple):
    """Σ W_IJ over listed pairs."""

    edges: Edges  # the curve's edges
    pairs: EdgePairIndices  # pairs i, j, sorted by i

    def value(self) -> float:
        return sum(scalars.energy() for _, scalars in self._parts())

    def value_and_derivative(self) -> tuple[float, EdgeDerivatives]:
        value, n, coefficients = 0.0, len(self.edges.tau), [np.empty(len(self.pairs[0])) for _ in range(4)]
        for part, scalars in self._parts():
            value += scalars.energy()
            for whole, values in zip(coefficients, scalars.coefficients(), strict=True):
                whole[part] = values
        row_ends = np.searchsorted(self.pairs[0], np.arange(n + 1))
        s, a, b, c = (sp.csr_array((entries, self.pairs[1], row_ends), shape=(n, n)) for entries in coefficients)
        sums = PartnerSums.zeros(self.edges)
        sums.add(slice(None), slice(None), (s, a, b, c), self.edges)
        return value, sums.derivatives(self.edges)

    def _parts(self) -> Iterator[tuple[slice, Pairs]]:
        """Some pairs at a time, and their scalars, each of shape (pairs,)."""
        m = self.edges.tau.shape[1]
        # midpoint, edge vector and length of each edge, one below the other; shape (2m + 1, edges)
        columns = np.ascontiguousarray(np.column_stack([self.edges.m, self.edges.e_ell]).T)
        for first in range(0, len(self.pairs[0]), PAIRS):
            part = slice(first, first + PAIRS)
            i, j = (np.take(columns, side[part], axis=1) for side in self.pairs)
            d, e_ell, f_ell = i[:m] - j[:m], i[m:], j[m:]
            s = 1.0 / dot(d, d)
            yield part, Pairs(dot(e_ell, f_ell), dot(d, e_ell[:-1]) * s, dot(d, f_ell[:-1]) * s, s)


class FarField:
    """Σ W_IJ over all blocks of a list, unordered pairs, by expansions of order p about the centers of clusters.

    A cluster has two moments, one below the other in one array.  With u_I = m_I − center they are Σ_I ℓ_I exp⟨u_I, ξ⟩
    up to degree p, for the kernel 1/|Δ|², and Σ_I ⟨e_I, ξ⟩ exp⟨u_I, ξ⟩ up to degree p + 1, for log|Δ|.  A kernel's part
    of a block is Σ_αβ M_α N_β ∂^{α+β} φ, over |α|, |β| ≥ k and |α + β| ≤ 2k + p with k = 0 and k = 1.

    The list may be that of a curve nearby; edges are of size 1, because high powers of lengths occur.
    """

    def __init__(self, blocks: BlockList, edges: Edges, order: int) -> None:
        m = edges.tau.shape[1]
        self._blocks, self._tree, self._edges, self._order = blocks, blocks.tree, edges, order
        # of all degrees needed, including those of the kernels' derivatives
        self._table = table = polynomials(m, order + 3)
        a, b = table.size(order), table.size(order) + table.size(order + 1)
        self._rows = slice(0, a), slice(a, b)  # of the two moments,
        self._by_center = slice(b, b + m)  # and in arrays of derivatives by them also those by the center
        # of the second cluster of a block relative to the first, since d becomes −d; shape (rows,)
        signs = table.signs[:, 0]
        self._signs = np.concatenate([signs[:a], -signs[: b - a], np.full(m, -1.0)])
        self._counts = self._tree.stop - self._tree.start
        self._centers = self._tree.reduced(np.add, edges.m[self._tree.order]) / self._counts[:, None]

    def value(self) -> float:
        total = 0.0
        for _, _, kernels, own, other in self._chunks():
            for k, kernel in enumerate(kernels):
                total += float(np.vdot(own[k], self._by_moments(k, kernel, other[k])))
        return total

    def value_and_derivative(self) -> tuple[float, EdgeDerivatives]:
        value, by_first = 0.0, np.zeros((self._tree.size, self._by_center.stop))
        by_second, contract = np.zeros_like(by_first), self._table.contract
        for first, second, kernels, own, other in self._chunks():
            by_own, by_other, by_center = [], [], np.zeros((len(self._edges.tau[0]), len(first)))
            for k, kernel in enumerate(kernels):
                by_own.append(self._by_moments(k, kernel, other[k]))
                by_other.append(self._by_moments(k, kernel, own[k]))
                value += float(np.vdot(own[k], by_own[k]))
                # by the first center, the edges at rest, only terms of the highest order remain: any other change of d
                # is undone by that of the moments
                degrees, highest = range(k + 1, k + self._order + 2), 2 * k + self._order + 1
                raised = contract(kernel, other[k], degrees, range(highest, highest + 1))
                by_center += contract(raised, own[k], range(1, 2), degrees)[1:]
            for total, clusters, parts in ((by_first, first, by_own), (by_second, second, by_other)):
                # clusters, a few of which occur several times
                order = np.argsort(clusters, kind="stable")
                starts = np.flatnonzero(np.diff(clusters[order], prepend=-1))
                values = np.take(np.concatenate([*parts, by_center]), order, axis=1).T
                total[clusters[order[starts]]] += np.add.reduceat(values, starts)
        # by the moments at fixed centers, and by the centers; shape (clusters, rows)
        local = by_first + by_second * self._signs
        local[:, self._by_center] /= self._counts[:, None]
        # from the clusters' down to those by edge vectors, midpoints and lengths (L2L and L2P)
        p, (of_lengths, of_edges), (n, m) = self._order, self._rows, self._edges.tau.shape
        for parents, children in _links(self._tree.downward()):
            theirs, shift, moved = _rows_of(local, parents), self._shifts(parents, children), []
            for k, rows in enumerate(self._rows):
                degrees = range(k, p + k + 1)
                moved.append(contract(theirs[rows], shift, degrees, degrees))
            local[children] += np.concatenate([*moved, theirs[self._by_center]]).T
        sums = EdgeDerivatives(np.zeros((n, m)), np.zeros((n, m)), np.zeros(n))
        for _, positions, leaf_of in self._leaves():
            at, ell, e = _rows_of(local, leaf_of), self._edges.ell[positions], self._edges.e[positions]
            power = self._table.exponentials((self._edges.m[positions] - self._centers[leaf_of]).T, p)
            by_length = contract(at[of_lengths], power, range(2), range(p + 1))
            by_edge = contract(at[of_edges], power, range(1, 3), range(1, p + 2))
            linear = np.concatenate([np.zeros((1, len(e))), e.T])
            by_midpoint = ell * by_length[1:] + at[self._by_center]
            by_midpoint += contract(by_edge, linear, range(1, 2), range(2, 3))[1:]
            sums.by_edge[positions] = by_edge[1 : m + 1].T
            sums.by_midpoint[positions] = by_midpoint.T
            sums.by_length[positions] = by_length[0]
        return value, sums

    def _chunks(
        self,
    ) -> Iterator[tuple[IntArray, IntArray, tuple[FloatArray, FloatArray], list[FloatArray], list[FloatArray]]]:
        """Some blocks' two clusters, both kernels' derivatives there, and both moments of both clusters (M2L)."""
        # the moments of all clusters, from the leaves up (P2M and M2M); shape (clusters, rows)
        table, moments = self._table, np.zeros((self._tree.size, self._by_center.start))
        for leaves, positions, leaf_of in self._leaves():
            power = table.exponentials((self._edges.m[positions] - self._centers[leaf_of]).T, self._order)
            both = self._edges.ell[positions] * power, table.multiply_linear(self._edges.e[positions].T, power)
            begin = self._tree.start[leaves] - self._tree.start[leaves[0]]
            moments[leaves] = np.add.reduceat(np.concatenate(both), begin, axis=1).T
        for parents, children in _links(self._tree.upward()):
            shift, theirs = self._shifts(parents, children), _rows_of(moments, children)
            moved = [table.multiply(theirs[rows], shift, self._order + k) for k, rows in enumerate(self._rows)]
            moments[parents] += np.concatenate(moved).T
        signed = moments * self._signs[: self._by_center.start]
        for start in range(0, len(self._blocks.first), CHUNK):
            first, second = (side[start : start + CHUNK] for side in (self._blocks.first, self._blocks.second))
            d = np.ascontiguousarray((self._centers[first] - self._centers[second]).T)
            own, other = _rows_of(moments, first), _rows_of(signed, second)
            kernels = kernel_derivatives(table, d, self._order + 1)
            yield first, second, kernels, [own[rows] for rows in self._rows], [other[rows] for rows in self._rows]

    def _by_moments(self, k: int, kernel: FloatArray, other: FloatArray) -> FloatArray:
        """A kernel's derivatives with respect to one cluster's moments, from the other's; shape (monomials, k)."""
        degrees, totals = range(k, k + self._order + 1), range(2 * k, 2 * k + self._order + 1)
        return self._table.contract(kernel, other, degrees, totals)

    def _shifts(self, parents: IntArray, children: IntArray) -> FloatArray:
        """exp⟨h, ξ⟩ for h from the parents' centers to the children's; shape (monomials, k)."""
        return self._table.exponentials((self._centers[children] - self._centers[parents]).T, self._order)

    def _leaves(self) -> Iterator[tuple[IntArray, IntArray, IntArray]]:
        """Some leaves at a time, their edges, and the leaf of each of these."""
        leaves, tree = self._tree.leaves(), self._tree
        step = max(1, CHUNK * len(leaves) // len(tree.order))
        for first in range(0, len(leaves), step):
            own = leaves[first : first + step]
            yield own, tree.order[tree.start[own[0]] : tree.stop[own[-1]]], np.repeat(own, self._counts[own])


def _links(levels: Iterable[tuple[IntArray, IntArray]]) -> Iterator[tuple[IntArray, IntArray]]:
    """Parents with one child of each, level by level, some at a time."""
    for inner, child in levels:
        for first in range(0, len(inner), CHUNK):
            parents, children = inner[first : first + CHUNK], child[first : first + CHUNK]
            yield parents, children
            yield parents, children + 1


def _rows_of(array: FloatArray, clusters: IntArray) -> FloatArray:
    """The entries for some clusters of an array of shape (clusters, rows), contiguous by rows; shape (rows, k)."""
    return np.ascontiguousarray(np.take(array, clusters, axis=0).T)
