"""Listed pairs of edges, summed exactly: the dense code's scalars pair by pair, its matrix products as sparse ones."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from ..curve.tiles import EdgePairIndices
from ..energies.moebius_pairs import Coefficients, DerivativeSums, Edges, Pairs
from ..types import FloatArray, IntArray

CHUNK = 8192  # pairs handled at once, for the processor's cache


@dataclass(frozen=True, eq=False)
class NearField:
    """Σ W_IJ over listed pairs.

    Parameters
    ----------
    edges
        The curve's edges.
    pairs
        Pairs i, j, sorted by i.
    """

    edges: Edges
    pairs: EdgePairIndices

    def value(self) -> float:
        """The sum."""
        return sum(self._scalars(part).energy() for part in self._parts())

    def value_and_derivative(self) -> tuple[float, DerivativeSums]:
        """The sum and the sums that make its derivative."""
        value, coefficients = 0.0, Coefficients(*(np.empty(len(self.pairs[0])) for _ in Coefficients._fields))
        for part in self._parts():
            scalars = self._scalars(part)
            value += scalars.energy()
            for whole, values in zip(coefficients, scalars.coefficients(), strict=True):
                whole[part] = values
        sums = DerivativeSums.zeros(*self.edges.tau.shape)
        sums.add(slice(None), slice(None), Coefficients(*map(self._matrix, coefficients)), self.edges.vectors)
        return value, sums

    def _parts(self) -> Iterator[slice]:
        return (slice(first, first + CHUNK) for first in range(0, len(self.pairs[0]), CHUNK))

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
        return sp.csr_array((entries, self.pairs[1], self._row_ends), shape=(n, n))

    @cached_property
    def _row_ends(self) -> IntArray:
        return np.searchsorted(self.pairs[0], np.arange(len(self.edges.tau) + 1))


def _inner(x: FloatArray, y: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("ik,ik->k", x, y))
