"""The Möbius energy of near pairs one by one, and of blocks by Taylor expansion about the centers of their clusters.

With G = log|Δ| the contribution of a pair of edges is W_IJ = ℓ_I ℓ_J/|Δ|² + ⟨e_I, ∇⟩⟨e_J, ∇⟩ G: sums over a block are
products of two moments applied to two kernels, both up to the same order, so that errors cancel on straight pieces.
The derivative is exactly that of the value.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

from ...base.types import FloatArray, IntArray
from ..edge_pairs import EdgePairIndices
from ..moebius_pairs import Coefficients, DerivativeSums, Edges, Pairs, PartnerSums, Vectors
from .blocks import BlockList
from .moments import Expansion, MomentTree, polynomial_rows
from .polynomials import kernel_derivatives

BLOCKS, PAIRS = 1024, 8192  # processed together, for the processor's cache


@dataclass(frozen=True, eq=False)
class NearField:
    """Σ W_IJ over listed pairs."""

    edges: Edges  # the curve's edges
    pairs: EdgePairIndices  # pairs i, j, sorted by i

    def value(self) -> float:
        return sum(self._scalars(part).energy() for part in self._parts())

    def value_and_derivative(self) -> tuple[float, DerivativeSums]:
        value, coefficients = 0.0, Coefficients(*(np.empty(len(self.pairs[0])) for _ in Coefficients._fields))
        for part in self._parts():
            scalars = self._scalars(part)
            value += scalars.energy()
            for whole, values in zip(coefficients, scalars.coefficients(), strict=True):
                whole[part] = values
        sums = PartnerSums.zeros(self.edges.vectors)
        sums.add(slice(None), slice(None), Coefficients(*map(self._matrix, coefficients)), self.edges.vectors)
        return value, sums.derivatives(self.edges.vectors)

    def _parts(self) -> Iterator[slice]:
        return (slice(first, first + PAIRS) for first in range(0, len(self.pairs[0]), PAIRS))

    def _scalars(self, part: slice) -> Pairs:
        """The scalars of some pairs, each of shape (pairs,)."""
        dimension = self.edges.tau.shape[1]
        i, j = (np.take(self._columns, side[part], axis=1) for side in self.pairs)
        (m, e_ell), (n, f_ell) = np.split(i, [dimension]), np.split(j, [dimension])
        d = m - n
        s = 1.0 / _inner(d, d)
        return Pairs(_inner(e_ell, f_ell), _inner(d, e_ell[:-1]) * s, _inner(d, f_ell[:-1]) * s, s)

    @cached_property
    def _columns(self) -> FloatArray:
        """Midpoint, edge vector and length of each edge, one below the other; shape (2m + 1, edges)."""
        return np.ascontiguousarray(np.column_stack([self.edges.vectors.m, self.edges.vectors.e_ell]).T)

    def _matrix(self, entries: FloatArray) -> sp.csr_array:
        """Numbers of the pairs as a sparse matrix; shape (edges, edges)."""
        n = len(self.edges.tau)
        row_ends = np.searchsorted(self.pairs[0], np.arange(n + 1))
        return sp.csr_array((entries, self.pairs[1], row_ends), shape=(n, n))


class _Kernel(NamedTuple):
    """One of the two kernels φ: its derivatives at some blocks (M2L), and the moments M, N of both clusters.

    Its part of the energy is Σ_αβ M_α N_β ∂^{α+β} φ, |α|, |β| ≥ ``lowest`` and |α + β| ≤ 2 ``lowest`` + p.
    """

    expansion: Expansion
    lowest: int
    derivatives: FloatArray
    first: FloatArray
    second: FloatArray

    def by_moments(self, other: FloatArray) -> FloatArray:
        """Its derivatives with respect to one cluster's moments, from the other's; shape (monomials, k)."""
        highest = self.lowest + self.expansion.order
        totals = range(2 * self.lowest, self.lowest + highest + 1)
        return self.expansion.table.contract(self.derivatives, other, range(self.lowest, highest + 1), totals)

    def by_center(self) -> FloatArray:
        """Its derivative with respect to the first center, the edges at rest; minus the second's; shape (m, k).

        Only terms of the highest order remain: any other change of d is undone by that of the moments.
        """
        degrees = range(self.lowest + 1, self.lowest + self.expansion.order + 2)
        totals = range(self.lowest + degrees[-1], self.lowest + degrees[-1] + 1)
        raised = self.expansion.table.contract(self.derivatives, self.second, degrees, totals)
        return self.expansion.table.contract(raised, self.first, range(1, 2), degrees)[1:]


@dataclass(frozen=True, eq=False)
class FarField:
    """Σ W_IJ over all blocks of a list, unordered pairs."""

    blocks: BlockList  # the list, made at this curve or at one nearby
    vectors: Vectors  # the curve's edges; of size 1, because high powers of lengths occur
    order: int  # p, the order of the expansions in distances from the centers

    @cached_property
    def _expansion(self) -> Expansion:
        return Expansion.of(self.vectors.m.shape[1], self.order)

    @cached_property
    def _clusters(self) -> MomentTree:
        return MomentTree(self.blocks.tree, self._expansion, self.vectors)

    def value(self) -> float:
        kernels = (kernel for _, _, *both in self._chunks() for kernel in both)
        return sum(float(np.vdot(kernel.first, kernel.by_moments(kernel.second))) for kernel in kernels)

    def value_and_derivative(self) -> tuple[float, DerivativeSums]:
        value, by_first = 0.0, np.zeros((self.blocks.tree.size, self._expansion.by_center.stop))
        by_second = np.zeros_like(by_first)
        for first, second, square, log in self._chunks():
            by_center = square.by_center() + log.by_center()
            own = [kernel.by_moments(kernel.second) for kernel in (square, log)]
            other = [kernel.by_moments(kernel.first) for kernel in (square, log)]
            value += float(np.vdot(square.first, own[0]) + np.vdot(log.first, own[1]))
            _add_rows(by_first, first, np.concatenate([*own, by_center]))
            _add_rows(by_second, second, np.concatenate([*other, by_center]))
        by_second *= self._expansion.signs
        by_second += by_first
        return value, self._clusters.derivative_sums(by_second)

    def _chunks(self) -> Iterator[tuple[IntArray, IntArray, _Kernel, _Kernel]]:
        """The two clusters, and the kernels 1/|Δ|² and log|Δ|, of some blocks at a time."""
        moments, centers, x = self._clusters.moments(), self._clusters.centers, self._expansion
        signed = moments * x.signs[: x.edges.stop]
        for start in range(0, len(self.blocks.first), BLOCKS):
            first, second = (side[start : start + BLOCKS] for side in (self.blocks.first, self.blocks.second))
            d = np.ascontiguousarray((centers[first] - centers[second]).T)
            square, log = kernel_derivatives(x.table, d, self.order + 1)
            own, other = polynomial_rows(moments, first), polynomial_rows(signed, second)
            kernel = _Kernel(x, 0, square, own[x.lengths], other[x.lengths])
            yield first, second, kernel, _Kernel(x, 1, log, own[x.edges], other[x.edges])


def _add_rows(total: FloatArray, clusters: IntArray, values: FloatArray) -> None:
    """Add values, shape (rows, k), to some clusters, a few of which occur several times; total (clusters, rows)."""
    order = np.argsort(clusters, kind="stable")
    ordered = clusters[order]
    starts = np.flatnonzero(np.diff(ordered, prepend=-1))
    total[ordered[starts]] += np.add.reduceat(np.take(values, order, axis=1).T, starts)


def _inner(x: FloatArray, y: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("ik,ik->k", x, y))
