"""Models of inner products of order 3/2 that fast Fourier transforms invert, for edges of similar lengths.

On a polygon of equal edges the seminorm of W^{3/2,2} is a circulant matrix, and J_C is spectrally equivalent to one.
It grows like ℓ⁻² with the edge length ℓ.  Where this varies from component to component, u/ℓ is the right unknown;
along one component it is not, because multiplying by a function with jumps is not bounded in W^{3/2,2}: iterations
would grow with n, whereas with one scale they only grow with the ratio of lengths.
"""

import numpy as np
from scipy.fft import irfft, rfft

from ..curve import Mesh
from ..types import FloatArray
from .krylov import LinearMap
from .symbol import LEAST, Parameter, Symbol, autocorrelation


class Circulants:
    """M = W⁻¹ F W⁻¹, F circulant on each component, of one symbol, and W the mean edge length of the component.

    A model of the product ``apply``, u to A u, (n, k) to (n, k), on a mesh of closed components; ``lengths`` are those
    of the edges, shape (n,).  A LinAlgError says if A is not positive definite.
    """

    def __init__(self, mesh: Mesh, lengths: FloatArray, apply: LinearMap) -> None:
        self._transform = ComponentTransform(mesh)
        means = np.add.reduceat(lengths, mesh.offsets[:-1]) / np.asarray(mesh.component_sizes)
        self._scale = means[mesh.component, None]
        one = np.ones(mesh.size)
        symbol = Parameter.of_steps(mesh, one).symbol(lambda v: self._scale * apply(self._scale * v), one, np.pi)
        values = self._transform.sampled(symbol)
        self._inverse = [1.0 / value for value in values]
        stretches = self._transform.sampled(lambda theta: 4.0 * np.sin(0.5 * theta) ** 2)
        self._compliance = [stretch / value for value, stretch in zip(values, stretches, strict=True)]

    def solve(self, f: FloatArray) -> FloatArray:
        return np.asarray(self._scale * self._transform.filtered(self._scale * f, self._inverse))

    def tension(self, tangents: FloatArray) -> LinearMap:
        """With D F⁻¹ Dᵀ, which is circulant, modulated by the directions of edges."""
        weighted = self._scale * tangents
        size = np.linalg.norm(weighted, axis=1, keepdims=True)
        modulated = self._transform.modulated(self._compliance, weighted / size)
        factors = [1.0 / np.maximum(each, LEAST * each.max(axis=1, keepdims=True)) for each in modulated]
        return lambda g: self._transform.filtered(g[:, None] / size, factors)[:, 0] / size[:, 0]


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
        (Chan, An optimal circulant preconditioner for Toeplitz systems, SIAM J. Sci. Stat. Comput. 9, 1988).  For every
        size of components ``factors`` have shape (frequencies,), the result (components, frequencies); t has (n, m).
        """
        return [
            rfft(autocorrelation(t[rows]) * irfft(factor, size)).real
            for size, rows, factor in zip(self._sizes, self._rows, factors, strict=True)
        ]

    def filtered(self, u: FloatArray, factors: list[FloatArray]) -> FloatArray:
        """The circulant matrix of sampled factors, or those of modulated ones, times u; shape (n, k)."""
        result = np.empty_like(u)
        for size, rows, factor in zip(self._sizes, self._rows, factors, strict=True):
            result[rows] = irfft(rfft(u[rows], axis=1) * factor[..., None], size, axis=1)
        return result
