"""Models of inner products of order 3/2 that fast Fourier transforms invert, for edges of similar lengths.

On a polygon of equal edges the seminorm of W^{3/2,2} is a circulant matrix, and J_C is spectrally equivalent to one.
It grows like ℓ⁻² with the edge length ℓ.  Where this varies from component to component, u/ℓ is the right unknown;
along one component it is not, because multiplying by a function with jumps is not bounded in W^{3/2,2}: iterations
would grow with n, whereas with one scale they only grow with the ratio of lengths.
"""

import numpy as np

from ..curve import Mesh
from ..types import FloatArray
from .fourier import ComponentTransform
from .krylov import LinearMap
from .symbol import LEAST, Parameter


class Circulants:
    """M = W⁻¹ F W⁻¹, F circulant on each component, of one symbol, and W the mean edge length of the component.

    Parameters
    ----------
    mesh
        Connectivity; all components are closed.
    lengths
        Edge lengths, positive, shape (n,).
    apply
        The product A u that M is a model of, (n, k) to (n, k).

    Raises
    ------
    numpy.linalg.LinAlgError
        If A is not positive definite.
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
        """M⁻¹ f; shape (n, k)."""
        return np.asarray(self._scale * self._transform.filtered(self._scale * f, self._inverse))

    def tension(self, tangents: FloatArray) -> LinearMap:
        """With D F⁻¹ Dᵀ, which is circulant, modulated by the directions of edges."""
        weighted = self._scale * tangents
        size = np.linalg.norm(weighted, axis=1, keepdims=True)
        modulated = self._transform.modulated(self._compliance, weighted / size)
        factors = [1.0 / np.maximum(each, LEAST * each.max(axis=1, keepdims=True)) for each in modulated]
        return lambda g: self._transform.filtered(g[:, None] / size, factors)[:, 0] / size[:, 0]
