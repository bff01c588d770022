"""The Möbius energy of blocks by Taylor expansion about the centres of their clusters, and its exact derivative.

With G = log|Δ| the contribution of a pair of edges is W_IJ = (ℓ_I ℓ_J/|Δ|²) + ⟨e_I, ∇⟩⟨e_J, ∇⟩ G: sums over a block are
products of two moments applied to two kernels, both up to the same order, so that errors cancel on straight pieces.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..energies.moebius_pairs import DerivativeSums, Vectors
from ..types import FloatArray, IntArray
from .blocks import BlockList
from .kernels import kernel_derivatives
from .moments import Moments, MomentTree
from .polynomials import Polynomials, polynomials

CHUNK = 512  # blocks handled at once, for the processor's cache


class _Kernel(NamedTuple):
    """One of the two kernels φ: its derivatives at some blocks, and the lowest degree of the moments it meets."""

    table: Polynomials
    order: int
    lowest: int
    derivatives: FloatArray

    def local(self, moments: FloatArray) -> FloatArray:
        """Derivatives of Σ_αβ M_α N_β ∂^{α+β} φ, |α + β| within the order, with respect to M; N are ``moments``."""
        p, lowest = self.order, self.lowest
        totals = range(2 * lowest, 2 * lowest + p + 1)
        return self.table.contract(self.derivatives, moments, range(lowest, lowest + p + 1), totals)

    def pull(self, first: FloatArray, second: FloatArray) -> FloatArray:
        """The sum's derivative with respect to the first centre, moments following; minus the second's; shape (m, k).

        Of all terms only those of the highest order are left: the others only change places.
        """
        p, lowest = self.order, self.lowest
        highest = 2 * lowest + p + 1
        degrees = range(lowest + 1, lowest + p + 2)
        raised = self.table.contract(self.derivatives, second, degrees, range(highest, highest + 1))
        return self.table.contract(raised, first, range(1, 2), degrees)[1:]


class _Chunk(NamedTuple):
    """Some blocks: their clusters, the moments of these, and the kernels; the second's are of −u, and so signed."""

    clusters: tuple[IntArray, IntArray]
    first: tuple[FloatArray, FloatArray]
    second: tuple[FloatArray, FloatArray]
    kernels: tuple[_Kernel, _Kernel]

    def energies(self) -> float:
        """Their part of the energy."""
        pairs = zip(self.kernels, self.first, self.second, strict=True)
        return sum(float(np.vdot(first, kernel.local(second))) for kernel, first, second in pairs)


@dataclass(frozen=True, eq=False)
class FarField:
    """Σ W_IJ over all blocks of a list, unordered pairs.

    Parameters
    ----------
    blocks
        The list, made at this curve or at one nearby.
    vectors
        The curve's edges; of size 1, for high powers of lengths are in use.
    order
        p, the order of the expansions in distances from the centres.
    """

    blocks: BlockList
    vectors: Vectors
    order: int

    @cached_property
    def _table(self) -> Polynomials:
        return polynomials(self.vectors.m.shape[1], self.order + 3)

    @cached_property
    def _clusters(self) -> MomentTree:
        return MomentTree(self.blocks.tree, self._table, self.order, self.vectors)

    @cached_property
    def _signs(self) -> Moments:
        """Signs of the moments of −u: Σ ℓ exp⟨−u, ξ⟩ and Σ ⟨e, ξ⟩ exp⟨−u, ξ⟩."""
        signs = self._table.signs.T
        return Moments(signs[:, : self._table.size(self.order)], -signs[:, : self._table.size(self.order + 1)])

    def _chunks(self) -> Iterator[_Chunk]:
        moments, centres = self._clusters.moments(), self._clusters.centres
        signed = Moments(*(sign * array for sign, array in zip(self._signs, moments, strict=True)))
        for start in range(0, len(self.blocks.first), CHUNK):
            first, second = (side[start : start + CHUNK] for side in (self.blocks.first, self.blocks.second))
            d = np.ascontiguousarray((centres[first] - centres[second]).T)
            square, log = kernel_derivatives(self._table, d, self.order + 1)
            kernels = _Kernel(self._table, self.order, 0, square), _Kernel(self._table, self.order, 1, log)
            yield _Chunk((first, second), moments.of(first), signed.of(second), kernels)

    def value(self) -> float:
        """The sum."""
        return sum(chunk.energies() for chunk in self._chunks())

    def value_and_derivative(self) -> tuple[float, DerivativeSums]:
        """The sum and the sums that make its derivative."""
        value, pull = 0.0, np.zeros_like(self._clusters.centres)
        by_first, by_second = self._clusters.zeros(), self._clusters.zeros()
        for chunk in self._chunks():
            own, other = chunk.clusters
            for k, (kernel, first, second) in enumerate(zip(chunk.kernels, chunk.first, chunk.second, strict=True)):
                local, force = kernel.local(second), kernel.pull(first, second)
                value += float(np.vdot(first, local))
                _add_rows(by_first[k], own, local)
                _add_rows(by_second[k], other, kernel.local(first))
                _add_rows(pull, own, force)
                _add_rows(pull, other, -force)
        for array, sign, signed in zip(by_first, self._signs, by_second, strict=True):
            array += sign * signed
        return value, self._clusters.hand_down(by_first, pull)


def _add_rows(total: FloatArray, rows: IntArray, values: FloatArray) -> None:
    """Add polynomials, shape (monomials, k), to rows, some of which come several times."""
    order = np.argsort(rows, kind="stable")
    ordered = rows[order]
    starts = np.flatnonzero(np.diff(ordered, prepend=-1))
    total[ordered[starts]] += np.add.reduceat(np.take(values, order, axis=1).T, starts)
