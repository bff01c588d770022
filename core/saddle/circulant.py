"""Models of nonlocal inner products that fast Fourier transforms invert.

On a polygon of equal edges the seminorm of W^{3/2,2} is a circulant matrix, and J_C is spectrally equivalent to one.
Where edge lengths ℓ vary, an inner product of order 3/2 grows like ℓ⁻², so the circulant matrix is a model in the
unknown u/ℓ.
"""

import numpy as np

from ..curve import Mesh
from ..types import FloatArray
from .fourier import ComponentTransform, Symbol
from .krylov import LinearMap

FREQUENCIES = 12  # at which the symbol is asked for; more do not save an iteration
SMOOTHING = 16.0  # edges: to multiply by a rough function is not bounded in W^{3/2,2}, so ℓ is a moving average


class Circulants:
    """M = W⁻¹ F W⁻¹, F circulant on each component and W the smoothed lengths.

    Parameters
    ----------
    mesh
        Connectivity.
    lengths
        ℓ, positive, shape (n,).
    apply
        The product A u that M is a model of, (n, k) to (n, k).

    Raises
    ------
    numpy.linalg.LinAlgError
        If A is not positive definite.
    """

    def __init__(self, mesh: Mesh, lengths: FloatArray, apply: LinearMap) -> None:
        self._transform = ComponentTransform(mesh)
        self._scale = self._smoothed(lengths)
        symbol = _sampled_symbol(lambda v: self._scale * apply(self._scale * v), mesh)
        values = self._transform.sampled(symbol)
        # the circulant matrix D F⁻¹ Dᵀ of edge differences D vanishes on constants; any positive value does there
        stretches = self._transform.sampled(lambda theta: 4.0 * np.sin(0.5 * np.maximum(theta, theta[1])) ** 2)
        self._inverse = [1.0 / value for value in values]
        self._stiffness = [value / stretch for value, stretch in zip(values, stretches, strict=True)]

    def solve(self, f: FloatArray) -> FloatArray:
        """M⁻¹ f; shape (n, k)."""
        return self._scale * self._transform.filtered(self._scale * f, self._inverse)

    def solve_differences(self, g: FloatArray) -> FloatArray:
        """(D M⁻¹ Dᵀ)⁻¹ g for edge differences D, where edge lengths are equal, and near it elsewhere; shape (n, k)."""
        return self._transform.filtered(g / self._scale, self._stiffness) / self._scale

    def _smoothed(self, lengths: FloatArray) -> FloatArray:
        gaussian = self._transform.sampled(lambda theta: np.exp(-0.5 * (SMOOTHING * theta) ** 2))
        return np.exp(self._transform.filtered(np.log(lengths)[:, None], gaussian))


def _sampled_symbol(apply: LinearMap, mesh: Mesh) -> Symbol:
    """Rayleigh quotients at a few frequencies, interpolated between logarithms."""
    sizes = np.asarray(mesh.component_sizes)
    largest = int(sizes.max())
    theta = 2.0 * np.pi / largest * np.unique(np.rint(np.geomspace(1, largest // 2, FREQUENCIES)))
    waves = np.concatenate(_waves(mesh, theta), axis=1)
    energies = np.sum(waves * apply(waves), axis=0)
    squares = np.sum(waves * waves, axis=0)
    quotients = np.sum(energies.reshape(2, -1), axis=0) / np.sum(squares.reshape(2, -1), axis=0)
    if not quotients.min() > 0.0:
        raise np.linalg.LinAlgError("matrix is not positive definite: a Rayleigh quotient is not positive")
    logarithms = np.log(theta), np.log(quotients)
    return lambda angle: np.exp(np.interp(np.log(np.maximum(angle, theta[0])), *logarithms))


def _waves(mesh: Mesh, theta: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Cosines and sines of about these angles from vertex to vertex, on all components long enough; shapes (n, k)."""
    sizes = np.asarray(mesh.component_sizes)
    turns = np.rint(np.multiply.outer(sizes, theta) / (2.0 * np.pi))
    phase = (2.0 * np.pi * turns / sizes[:, None])[mesh.component]
    phase *= (np.arange(mesh.size) - mesh.offsets[mesh.component])[:, None]
    # of either sign at random, so that components do not move together
    signs = np.random.default_rng(1).choice([-1.0, 1.0], len(sizes))
    amplitude = ((turns > 0.0) * signs[:, None])[mesh.component]
    return amplitude * np.cos(phase), amplitude * np.sin(phase)
