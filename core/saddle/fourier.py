"""Discrete Fourier transforms along the components of a mesh."""

import numpy as np
from scipy.fft import irfft, rfft

from ..curve import Mesh
from ..types import FloatArray
from .symbol import Symbol, autocorrelation


class ComponentTransform:
    """Products with circulant matrices, one of the same symbol on each component.

    Components of one size are transformed together.  There are at most √(2n) different sizes, so thousands of small
    components are no slower than a large one.
    """

    def __init__(self, mesh: Mesh) -> None:
        sizes = np.asarray(mesh.component_sizes)
        self._sizes = [int(size) for size in np.unique(sizes)]
        self._rows = [mesh.offsets[:-1][sizes == size, None] + np.arange(size) for size in self._sizes]

    def sampled(self, symbol: Symbol) -> list[FloatArray]:
        """A symbol at the angles θ ∈ [0, π] from vertex to vertex that every size of components has."""
        return [symbol(2.0 * np.pi / size * np.arange(size // 2 + 1)) for size in self._sizes]

    def modulated(self, factors: list[FloatArray], t: FloatArray) -> list[FloatArray]:
        """Factors of the circulant matrices nearest to Σ_k diag(t_k) F diag(t_k), F that of sampled factors.

        Their entries are the means along the diagonals: those of F times the autocorrelation of t on the component
        (Chan, An optimal circulant preconditioner for Toeplitz systems, SIAM J. Sci. Stat. Comput. 9, 1988).

        Parameters
        ----------
        factors
            Shape (frequencies,) for every size of components.
        t
            Shape (n, m).

        Returns
        -------
        modulated
            Shape (components of the size, frequencies) for every size.
        """
        return [
            rfft(autocorrelation(t[rows]) * irfft(factor, size)).real
            for size, rows, factor in zip(self._sizes, self._rows, factors, strict=True)
        ]

    def filtered(self, u: FloatArray, factors: list[FloatArray]) -> FloatArray:
        """The circulant matrix of sampled factors, or those of modulated ones, times u; shape (n, k)."""
        if len(self._rows) == 1:
            shape = (*self._rows[0].shape, u.shape[1])
            return _filtered(u.reshape(shape), factors[0]).reshape(u.shape)
        result = np.empty_like(u)
        for rows, factor in zip(self._rows, factors, strict=True):
            result[rows] = _filtered(u[rows], factor)
        return result


def _filtered(u: FloatArray, factor: FloatArray) -> FloatArray:
    return np.asarray(irfft(rfft(u, axis=1) * factor[..., None], u.shape[1], axis=1))
