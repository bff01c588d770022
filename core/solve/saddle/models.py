"""Models of inner products on links, and on functions that vanish at pins: by symbols, and by resolvents.

Resolvents of the Laplacian along the curve serve for order 3/2 and any edge lengths.  For λ > 0 we have λ^{-3/2} = 2/π
∫ σ^{1/2} (λ + σ)⁻² dσ and λ^{1/2} = 1/π ∫ σ^{-1/2} λ (λ + σ)⁻¹ dσ.  By the trapezoidal rule in log σ both are sums over
a few σ, and with a symbol f(σ) in place of σ^{3/2}, or one in place of σ^{1/2}, slowly varying in comparison, they are
near 1/f(λ), or near this one at λ.  Each resolvent is a sparse factorisation with three entries a row, for all
components at once: together several times slower than a Fourier transform, but insensitive to the mesh.
"""

import numpy as np
import scipy.sparse as sp
from scipy.linalg import cho_factor, cho_solve

from ...base.types import FloatArray, IntArray
from ...curve import Mesh
from ...curve.pins import holds
from .dense import factorised
from .krylov import LinearMap, Model
from .symbol import Parameter, modulated

SPACING = 3.5  # of log σ: with 2.3 there is no iteration less, with 5 there are half as many more


class TwoLevel:
    """M⁻¹ = M₀⁻¹ + Z E⁻¹ Zᵀ with E = coupling + V Vᵀ, Z the indicators of the components.

    Components of a link hold each other like masses on springs.  Their graph may be long, such as that of a chain,
    which a model M₀ along the components, ``fine``, does not see; a sparse factorisation of one row a component does.
    ``coupling`` is positive semidefinite, ``vectors`` V have shape (components, r).  A LinAlgError says if E is
    singular.
    """

    def __init__(self, mesh: Mesh, fine: Model, coupling: sp.sparray, vectors: FloatArray) -> None:
        self._fine = fine
        self.tension = fine.tension  # as a whole components have no edge differences
        self._component, self._starts = mesh.component, mesh.offsets[:-1]
        self._rank = vectors.shape[1]
        border = sp.csr_array(vectors)
        # V Vᵀ would be dense
        self._factor = factorised(sp.block_array([[coupling, border], [border.T, -sp.eye_array(self._rank)]]))

    def solve(self, f: FloatArray) -> FloatArray:
        force = np.add.reduceat(f, self._starts, axis=0)
        padded = np.concatenate([force, np.zeros((self._rank, f.shape[1]))])
        shift = self._factor.solve(padded)[: len(force)]
        return np.asarray(self._fine.solve(f) + shift.take(self._component, axis=0))


class PinnedModel:
    """A model M restricted to functions that vanish at pins: its inverse, continued by 0 to the pins.

    That is M⁻¹ − M⁻¹E (Eᵀ M⁻¹ E)⁻¹ Eᵀ M⁻¹, E the unit functions of the pins.  A restriction inherits the bounds of
    eigenvalues.  Of many pins in a row only the first and the last ones count: beyond them hardly anything is left.
    For k pins near free vertices it takes k solves with M, and room for k·n numbers.  A LinAlgError says if M is not
    positive definite.
    """

    def __init__(self, whole: Model, mesh: Mesh, pins: IntArray) -> None:
        self._whole, self._pins = whole, pins
        self.tension = whole.tension  # pins change the Schur complement by a matrix of low rank, for a few iterations
        near = ~holds(mesh, pins)
        for _ in range(2):  # pins that count on either side of those in a row
            ahead, behind = mesh.heads[near[mesh.tails]], mesh.tails[near[mesh.heads]]
            near[ahead] = near[behind] = True
        self._near = pins[near[pins]] if near.any() else pins
        units = np.zeros((mesh.size, len(self._near)))
        units[self._near, np.arange(len(self._near))] = 1.0
        self._responses = whole.solve(units)
        self._compliance = cho_factor(self._responses[self._near], lower=True)

    def solve(self, f: FloatArray) -> FloatArray:
        """The solution with M, and forces at the pins that bring these back; shape (n, k)."""
        force = f.copy()
        force[self._pins] = 0.0
        u = self._whole.solve(force)
        u = u - self._responses @ cho_solve(self._compliance, u[self._near])
        u[self._pins] = 0.0
        return np.asarray(u)


def vanishing_at(pins: IntArray, model: Model, mesh: Mesh) -> Model:
    """A model on functions that vanish at pins, if there are any."""
    return PinnedModel(model, mesh, pins) if len(pins) else model


class Resolvents:
    """M = f(−Δ) with the symbol f of an inner product, −Δ the Laplacian of linear elements with lumped mass.

    A model of the product ``apply``, u to A u, (n, k) to (n, k); ``lengths`` ℓ are those of the edges, shape (edges,).
    A LinAlgError says if A is not positive definite.
    """

    def __init__(self, mesh: Mesh, lengths: FloatArray, apply: LinearMap) -> None:
        mass, d = 0.5 * mesh.scatter(lengths, lengths), mesh.difference
        parameter = Parameter.of_steps(mesh, mesh.at_tails(lengths))
        # nine in ten edges are shorter than half of any wave tried
        symbol = parameter.symbol(apply, mass, np.pi / float(np.quantile(lengths, 0.9)))
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
