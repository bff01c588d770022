"""The constraints Φ of Section 6.1.3 of [RS21]: prescribed edge lengths and a fixed barycenter.

Φ = (log ℓ_I − log ℓ⁰_I)_I together with Σ ℓ_I m_I minus its target.  Lengths enter as logarithms, so one
tolerance means the same relative error on every edge.
"""

from dataclasses import dataclass

import numpy as np

from .curve import Curve, Mesh
from .types import FloatArray


@dataclass(frozen=True, eq=False)
class Constraints:
    """Targets of the constraints.

    Parameters
    ----------
    lengths
        Target lengths ℓ⁰, positive, shape (n,).
    barycenter
        Target of Σ ℓ_I m_I, shape (m,).
    """

    lengths: FloatArray
    barycenter: FloatArray

    def residual(self, curve: Curve) -> FloatArray:
        """Φ(P): n logarithmic length errors, then the m barycenter errors; shape (n + m,)."""
        return np.concatenate([np.log(curve.edge_lengths / self.lengths), weighted_barycenter(curve) - self.barycenter])

    def length_error(self, curve: Curve) -> float:
        """max |log ℓ/ℓ⁰| over the edges."""
        return float(np.max(np.abs(np.log(curve.edge_lengths / self.lengths))))


def weighted_barycenter(curve: Curve) -> FloatArray:
    """Σ ℓ_I (P(I↑) + P(I↓))/2; shape (m,)."""
    return np.asarray(curve.edge_lengths @ curve.midpoints)


@dataclass(frozen=True, eq=False)
class ConstraintDerivative:
    """DΦ(P) as an operator; every constraint's derivative is linear in few numbers per edge.

    Attributes
    ----------
    mesh
        Connectivity.
    tangents
        τ_I/ℓ_I, so that the length rows are ⟨τ_I/ℓ_I, ΔU_I⟩; shape (n, m).
    barycenter
        Rows of the barycenter, entry (k, v, l) the derivative of coordinate k by coordinate l of vertex v;
        shape (m, n, m), or (0, n, m) without barycenter.
    """

    mesh: Mesh
    tangents: FloatArray
    barycenter: FloatArray

    @classmethod
    def of_lengths(cls, curve: Curve) -> "ConstraintDerivative":
        """The length rows alone."""
        tangents = curve.edge_vectors / curve.edge_lengths[:, None] ** 2
        return cls(curve.mesh, tangents, np.zeros((0, *curve.vertices.shape)))

    @classmethod
    def at(cls, curve: Curve) -> "ConstraintDerivative":
        """DΦ at the curve."""
        ell, mesh = curve.edge_lengths, curve.mesh
        tau = curve.edge_vectors / ell[:, None]
        mass = 0.5 * mesh.scatter(ell, ell)
        rows = np.zeros((curve.dimension, *curve.vertices.shape))
        for k in range(curve.dimension):
            stretch = curve.midpoints[:, k, None] * tau
            rows[k] = mesh.scatter(-stretch, stretch)
            rows[k, :, k] += mass
        return cls(mesh, tau / ell[:, None], rows)

    def apply(self, u: FloatArray) -> FloatArray:
        """DΦ u; shape (n + m,) from (n, m)."""
        along = np.einsum("ij,ij->i", self.tangents, u[self.mesh.heads] - u[self.mesh.tails])
        return np.concatenate([along, np.einsum("kvl,vl->k", self.barycenter, u)])

    def apply_transpose(self, multipliers: FloatArray) -> FloatArray:
        """DΦᵀ λ; shape (n, m) from (n + m,)."""
        n = self.mesh.size
        pull = multipliers[:n, None] * self.tangents
        pinned: FloatArray = np.einsum("kvl,k->vl", self.barycenter, multipliers[n:])
        return self.mesh.scatter(-pull, pull) + pinned
