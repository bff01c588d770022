"""Listed pairs of edges, summed exactly: the dense code's scalars pair by pair, its matrix products as sparse ones."""

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
        i, j = self.pairs
        parts = (slice(k, k + CHUNK) for k in range(0, len(i), CHUNK))
        return sum(_pairs(self.edges, i[part], j[part]).energy() for part in parts)

    def value_and_derivative(self) -> tuple[float, DerivativeSums]:
        """The sum and the sums that make its derivative."""
        i, j = self.pairs
        value, coefficients = 0.0, np.empty((4, len(i)))
        for k in range(0, len(i), CHUNK):
            part = slice(k, k + CHUNK)
            pairs = _pairs(self.edges, i[part], j[part])
            value += pairs.energy()
            coefficients[:, part] = pairs.coefficients()
        sums = DerivativeSums.zeros(*self.edges.tau.shape)
        sums.add(slice(None), slice(None), Coefficients(*map(self._matrix, coefficients)), self.edges.vectors)
        return value, sums

    def _matrix(self, entries: FloatArray) -> sp.csr_array:
        """Numbers of the pairs as a sparse matrix; shape (n, n)."""
        n = len(self.edges.tau)
        return sp.csr_array((entries, self.pairs[1], self._row_ends), shape=(n, n))

    @cached_property
    def _row_ends(self) -> IntArray:
        return np.searchsorted(self.pairs[0], np.arange(len(self.edges.tau) + 1))


def _pairs(edges: Edges, i: IntArray, j: IntArray) -> Pairs:
    """The scalars of pairs, each of shape (pairs,)."""
    e_ell, m = edges.vectors.e_ell, edges.vectors.m
    d = m[i] - m[j]
    own, other = e_ell[i], e_ell[j]
    s = 1.0 / np.einsum("ij,ij->i", d, d)
    p = np.einsum("ij,ij->i", d, own[:, :-1]) * s
    q = np.einsum("ij,ij->i", d, other[:, :-1]) * s
    return Pairs(np.einsum("ij,ij->i", own, other), p, q, s)
