"""Discrete Fourier transforms along the components of a mesh."""

import numpy as np
from scipy.fft import irfft, rfft

from ..curve import Mesh
from ..types import FloatArray
from .symbol import Symbol


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

    def filtered(self, u: FloatArray, factors: list[FloatArray]) -> FloatArray:
        """The circulant matrix of sampled factors times u; shape (n, k)."""
        if len(self._rows) == 1 and len(self._rows[0]) == 1:
            return _filtered(u, factors[0], 0)
        result = np.empty_like(u)
        for rows, factor in zip(self._rows, factors, strict=True):
            result[rows] = _filtered(u[rows], factor, 1)
        return result


def _filtered(u: FloatArray, factor: FloatArray, axis: int) -> FloatArray:
    return np.asarray(irfft(rfft(u, axis=axis) * factor[:, None], u.shape[axis], axis=axis))
