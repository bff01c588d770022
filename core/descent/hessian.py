"""Products with second derivatives, of the objective and of the Lagrangian, and Newton's direction by means of them."""

from collections.abc import Callable

import numpy as np

from ..deadline import check_time
from ..energies.moebius_hessian import OwnBlocks
from ..saddle import TangentSpace
from ..types import FloatArray
from .problem import Point

LinearMap = Callable[[FloatArray], FloatArray]
ASSEMBLED_SIZE = 3000  # unknowns up to which one assembled matrix beats products that go through all pairs


def energy_hessian(point: Point) -> LinearMap:
    objective, curve = point.problem.objective, point.curve
    if curve.vertices.size > ASSEMBLED_SIZE:
        return lambda v: objective.hessian_product(curve, v)
    matrix = objective.hessian(curve)
    return lambda v: np.asarray((matrix @ v.ravel()).reshape(v.shape))


def lagrangian_hessian(point: Point) -> LinearMap:
    """v ↦ (D²E − Σ λ_k D²Φ_k) v on tangent vectors v, with λ from (41).

    Rows are functions Φ(P, s) of vertices and logarithms s of edge lengths.  As ds = 0 along tangent vectors,
    D²Φ (v, ·) = ∂²_P Φ (v, ·) + ∂_s Φ · D²s (v, ·).
    """
    of_energy = energy_hessian(point)
    ell, mesh, constraints = point.curve.edge_lengths, point.problem.mesh, point.tangent_space.constraints
    tau = point.curve.edge_vectors / ell[:, None]
    weight = (constraints.loads(point.multipliers)[0] / ell**2)[:, None]

    def apply(v: FloatArray) -> FloatArray:
        # D² log ℓ (v, ·) = (Δv − 2 ⟨τ, Δv⟩ τ)/ℓ²
        dv = mesh.changes(v)
        bend = weight * (dv - 2.0 * np.einsum("ij,ij->i", tau, dv)[:, None] * tau)
        image = of_energy(v) - mesh.scatter(-bend, bend)
        for block, multipliers in constraints.of_blocks(point.multipliers):
            image = image - block.curvature(multipliers, v)
        return image

    return apply


def lagrangian_matrix(point: Point) -> FloatArray:
    """The same, the second derivatives of blocks left out, as a matrix on tangent vectors; shape (n·m, n·m)."""
    ell, mesh, (n, m) = point.curve.edge_lengths, point.problem.mesh, point.vertices.shape
    tau, tensions = point.curve.edge_vectors / ell[:, None], point.tangent_space.constraints.loads(point.multipliers)[0]
    normal = np.eye(m) - 2.0 * tau[:, :, None] * tau[:, None, :]
    matrix = point.problem.objective.hessian(point.curve)
    bend = OwnBlocks.zeros(mesh.edges, m)._replace(ee=(tensions / ell**2)[:, None, None] * normal)
    bend.add_to(matrix.reshape(n, m, n, m), mesh, -1.0)
    return matrix


def projected_conjugate_gradient(
    operator: LinearMap, right: FloatArray, space: TangentSpace, tolerance: float, max_iterations: int
) -> FloatArray:
    """Solve ⟨operator w − right, v⟩ = 0 for all tangent v, for tangent w, preconditioned by the metric of ``space``.

    The operator is symmetric, (n, m) to (n, m), the right side a covector, shape (n, m), and the tolerance relative to
    its norm. Steihaug's rule: on a direction of negative curvature the iteration ends with what it has (the first time
    with that direction's steepest-descent step), so the result is a direction of descent of the quadratic model.
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
