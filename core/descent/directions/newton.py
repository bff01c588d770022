"""Second-order information on the constraint manifold: the Lagrangian's Hessian and the Newton direction."""

from collections.abc import Callable

import numpy as np

from ...deadline import check_time
from ...saddle import TangentSpace
from ...types import FloatArray
from ..problem import Point

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


def lagrangian_hessian_matrix(point: Point) -> FloatArray:
    """The same as a dense symmetric matrix, shape (n·m, n·m)."""
    ell, mesh = point.curve.edge_lengths, point.problem.mesh
    n, m = point.vertices.shape
    tau = point.curve.edge_vectors / ell[:, None]
    weight = _curvature_weights(point)
    matrix = point.problem.objective.hessian(point.curve).reshape(n, m, n, m)
    blocks = weight[:, None, None] * (np.eye(m) - 2.0 * tau[:, :, None] * tau[:, None, :])
    by_vertices = matrix.transpose(0, 2, 1, 3)
    tail, head = mesh.tails, mesh.heads
    for a, b, sign in ((tail, tail, -1.0), (head, head, -1.0), (tail, head, 1.0), (head, tail, 1.0)):
        np.add.at(by_vertices, (a, b), sign * blocks)
    return matrix.reshape(n * m, n * m)


def _curvature_weights(point: Point) -> FloatArray:
    """The factor of |Δv_I|² in Σ λ D²Φ (v, v) for tangent v, of which ⟨τ_I, Δv_I⟩ = 0; shape (edges,).

    D² log ℓ_I has the factor 1/ℓ_I², D²(Σ ℓ_I m_I) = Σ m_I D²ℓ_I the factor m_I/ℓ_I.  The barycenter's multipliers
    vanish if it is that of the whole curve, because the energy does not change under translations.
    """
    ell, constraints = point.curve.edge_lengths, point.tangent_space.constraints
    forces = constraints.forces(point.multipliers)[point.curve.mesh.tails]
    along = np.einsum("ij,ij->i", forces, point.curve.midpoints)
    return np.asarray(constraints.tensions(point.multipliers) / ell**2 + along / ell)


def projected_conjugate_gradient(
    operator: LinearMap, right: FloatArray, space: TangentSpace, tolerance: float, max_iterations: int
) -> FloatArray:
    """Solve ⟨operator w − right, v⟩ = 0 for all tangent v, for tangent w, preconditioned by the metric.

    Steihaug's rule: on a direction of negative curvature the iteration ends with what it has (the first time with
    that direction's steepest-descent step), so the result is a direction of descent of the quadratic model.

    Parameters
    ----------
    operator
        Symmetric, (n, m) to (n, m).
    right
        Covector, shape (n, m).
    space
        Projects and preconditions; its norm measures the residual.
    tolerance
        Relative residual at which to stop.
    """
    w = np.zeros_like(right)
    residual = right.copy()
    z = space.gradient(residual)[0]
    square = float(np.sum(residual * z))
    bound = tolerance**2 * square
    direction = z
    for _ in range(max_iterations):
        if not square > bound:
            break
        check_time()
        image = operator(direction)
        curvature = float(np.sum(direction * image))
        if curvature <= 0.0:
            return w if np.any(w) else direction
        step = square / curvature
        w = w + step * direction
        residual = residual - step * image
        z = space.gradient(residual)[0]
        square, last = float(np.sum(residual * z)), square
        direction = z + (square / last) * direction
    return w


def newton_direction(point: Point, hessian: LinearMap, tolerance: float, max_iterations: int = 200) -> FloatArray:
    """Tangent w with (D²L w + DE) orthogonal to the tangent space, by projected conjugate gradients."""
    return projected_conjugate_gradient(hessian, -point.derivative, point.tangent_space, tolerance, max_iterations)
