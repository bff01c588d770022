"""Models of inner products of order 3/2 by resolvents of the Laplacian along the curve, for any edge lengths.

For λ > 0 we have λ^{-3/2} = 2/π ∫ σ^{1/2} (λ + σ)⁻² dσ and λ^{1/2} = 1/π ∫ σ^{-1/2} λ (λ + σ)⁻¹ dσ.  By the
trapezoidal rule in log σ both are sums over a few σ, and with a symbol f(σ) in place of σ^{3/2}, or one in place of
σ^{1/2}, slowly varying in comparison, they are near 1/f(λ), or near this one at λ.  Each resolvent is a sparse
factorisation with three entries a row, for all components at once: together several times slower than a Fourier
transform, but insensitive to the mesh.
"""

import numpy as np
import scipy.sparse as sp

from ..curve import Mesh
from ..types import FloatArray
from .krylov import LinearMap
from .sparse import factorised
from .symbol import Parameter, modulated

SPACING = 3.5  # of log σ: with 2.3 there is no iteration less, with 5 there are half as many more
RESOLVED = 0.9  # share of the edges that are shorter than half of any wave tried


class Resolvents:
    """M = f(−Δ) with the symbol f of an inner product, −Δ the Laplacian of linear elements with lumped mass.

    A model of the product ``apply``, u to A u, (n, k) to (n, k); ``lengths`` ℓ are those of the edges, shape (edges,).
    A LinAlgError says if A is not positive definite.
    """

    def __init__(self, mesh: Mesh, lengths: FloatArray, apply: LinearMap) -> None:
        mass, d = 0.5 * mesh.scatter(lengths, lengths), mesh.difference
        parameter = Parameter.of_steps(mesh, mesh.at_tails(lengths))
        symbol = parameter.symbol(apply, mass, np.pi / float(np.quantile(lengths, RESOLVED)))
        least, largest = (2.0 * np.pi / float(parameter.periods.max())) ** 2, 4.0 / float(lengths.min()) ** 2
        sigma = np.exp(np.arange(np.log(least), np.log(largest) + SPACING, SPACING))
        self._mass, self._lengths = mass[:, None], lengths[:, None]
        at_vertices = d.T @ sp.diags_array(1.0 / lengths) @ d
        at_edges = d @ sp.diags_array(1.0 / mass) @ d.T
        self._weights = 2.0 / np.pi * SPACING * sigma**2 / symbol(np.sqrt(sigma))
        self._sigma, self._symbol = sigma, symbol
        self._at_vertices = [factorised(at_vertices + s * sp.diags_array(mass)) for s in sigma]
        self._at_edges = [factorised(at_edges + s * sp.diags_array(lengths)) for s in sigma]

    def solve(self, f: FloatArray) -> FloatArray:
        total = np.zeros_like(f)
        for weight, factor in zip(self._weights, self._at_vertices, strict=True):
            total += weight * factor.solve(self._mass * factor.solve(f))
        return total

    def tension(self, tangents: FloatArray) -> LinearMap:
        """By λ^{1/2} with the inverse of the modulated symbol, which is constant on long waves, in place of σ^{1/2}."""
        lengths = self._lengths[:, 0]
        symbol = modulated(lambda w: w**2 / self._symbol(w), tangents * self._lengths, lengths)
        stiffness = np.maximum.accumulate(1.0 / symbol(np.sqrt(self._sigma)))
        weights = SPACING / np.pi * (stiffness - stiffness[0])

        def tension(change: FloatArray) -> FloatArray:
            right = lengths * change
            total = (stiffness[0] + np.sum(weights)) * change
            for weight, factor in zip(self._sigma * weights, self._at_edges, strict=True):
                total -= weight * factor.solve(right)
            return np.asarray(lengths * total)

        return tension
