"""Products with second derivatives: of the objective, and of the Lagrangian on the constraint manifold."""

from collections.abc import Callable

import numpy as np

from ..types import FloatArray
from .problem import Point

LinearMap = Callable[[FloatArray], FloatArray]
ASSEMBLED_SIZE = 3000  # up to so many unknowns one assembled matrix beats products that go through all pairs


def energy_hessian(point: Point) -> LinearMap:
    """v ↦ D²E v, (n, m) to (n, m)."""
    objective, curve = point.problem.objective, point.curve
    if curve.vertices.size > ASSEMBLED_SIZE:
        return lambda v: objective.hessian_product(curve, v)
    matrix = objective.hessian(curve)
    return lambda v: np.asarray((matrix @ v.ravel()).reshape(v.shape))


def lagrangian_hessian(point: Point) -> LinearMap:
    """v ↦ (D²E − Σ λ_I D²Φ_I) v on tangent vectors v, with λ from (41)."""
    of_energy = energy_hessian(point)
    ell, mesh = point.curve.edge_lengths, point.problem.mesh
    tau = point.curve.edge_vectors / ell[:, None]
    weight = _curvature_weights(point)[:, None]

    def apply(v: FloatArray) -> FloatArray:
        # D² log ℓ (v, ·) = (Δv − 2 ⟨τ, Δv⟩ τ)/ℓ²
        dv = v[mesh.heads] - v[mesh.tails]
        bend = weight * (dv - 2.0 * np.einsum("ij,ij->i", tau, dv)[:, None] * tau)
        return of_energy(v) - mesh.scatter(-bend, bend)

    return apply


def _curvature_weights(point: Point) -> FloatArray:
    """The factor of |Δv_I|² in Σ λ D²Φ (v, v) for tangent v, of which ⟨τ_I, Δv_I⟩ = 0; shape (edges,).

    D² log ℓ_I has the factor 1/ℓ_I², D²(Σ ℓ_I m_I) = Σ m_I D²ℓ_I the factor m_I/ℓ_I.  The barycenter's multipliers
    vanish if it is that of the whole curve, because the energy does not change under translations.
    """
    ell, constraints = point.curve.edge_lengths, point.tangent_space.constraints
    forces = constraints.forces(point.multipliers)[point.curve.mesh.tails]
    along = np.einsum("ij,ij->i", forces, point.curve.midpoints)
    return np.asarray(constraints.tensions(point.multipliers) / ell**2 + along / ell)
