"""Products with second derivatives, of the objective and of the Lagrangian, Newton's direction by them, and soft modes.

Soft modes are tangent directions in which the Lagrangian's Hessian is least against the metric, by products alone.
J_C⁻¹ D²L is an operator of order 0: on every mesh all but a few of its eigenvalues lie in a bulk from 0.2 to 2 or so,
so that 100 to 200 products find those below it, for any number of vertices.  This is Davidson's method in blocks: the
basis grows by the residuals of the lowest Ritz pairs, projected to the tangent space in the metric.  With exact
projections it is the block Lanczos method; loose ones, such as those of `saddle.iterative`, do no harm.

SciPy's solvers do not serve: ARPACK's may miss copies of multiple eigenvalues, which symmetric knots have; `lobpcg`
takes forces normal to the constraints for errors, and solves small problems in the whole space.
"""

from dataclasses import dataclass

import numpy as np

from ..base import BULK, FloatArray, dot
from ..energies.moebius import OwnBlocks
from ..solve.saddle import LinearMap, TangentSpace
from ..solve.saddle.iterative import conjugate_gradients
from .problem import Point

ASSEMBLED_SIZE = 3000  # unknowns up to which one assembled matrix beats products that go through all pairs


def energy_hessian(point: Point) -> LinearMap:
    objective, curve = point.problem.objective, point.curve
    if curve.vertices.size > ASSEMBLED_SIZE or not objective.is_assembled:
        return lambda v: objective.hessian_product(curve, v)
    matrix = objective.hessian(curve)
    return lambda v: np.asarray((matrix @ v.ravel()).reshape(v.shape))


def lagrangian_hessian(point: Point) -> LinearMap:
    """v ↦ (D²E − Σ λ_k D²Φ_k) v on tangent vectors v, with λ from (41).

    Rows are functions Φ(P, s) of vertices and logarithms s of edge lengths.  As ds = 0 along tangent vectors,
    D²Φ (v, ·) = ∂_s Φ · D²s (v, ·): barycenters are linear in either.
    """
    of_energy = energy_hessian(point)
    ell, mesh, constraints = point.curve.edge_lengths, point.problem.mesh, point.tangent_space.constraints
    tau = point.curve.edge_vectors / ell[:, None]
    weight = (constraints.loads(point.multipliers)[0] / ell**2)[:, None]

    def apply(v: FloatArray) -> FloatArray:
        # D² log ℓ (v, ·) = (Δv − 2 ⟨τ, Δv⟩ τ)/ℓ²
        dv = mesh.changes(v)
        bend = weight * (dv - 2.0 * tau * dot(tau, dv)[:, None])
        return of_energy(v) - mesh.scatter(-bend, bend)

    return apply


def lagrangian_matrix(point: Point) -> FloatArray:
    """The same as a matrix on tangent vectors; shape (n·m, n·m)."""
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
    its norm.  By Steihaug's rule the result is a direction of descent of the quadratic model.  The part of the residual
    that constraints balance is taken off it every time, as else its rounding hides the rest (Gould, Hribar and Nocedal,
    On the solution of equality constrained quadratic programming problems arising in optimization, 2001).
    """
    first = 0.0

    def precondition(r: FloatArray, decreases: list[float]) -> tuple[FloatArray, FloatArray] | None:
        nonlocal first
        z, multipliers = space.gradient(r)
        r = r - space.constraints.apply_transpose(multipliers)
        square = float(np.sum(r * z))
        first = first if decreases else square
        return (z, r) if square > tolerance**2 * first else None

    return conjugate_gradients(operator, precondition, right, max_iterations, indefinite=True)


@dataclass(frozen=True, eq=False)
class SoftModes:
    """All Ritz pairs of J⁻¹(D²E − Σ λ_I D²Φ_I) on ker DΦ after a search, ascending; the lowest are good."""

    values: FloatArray  # Ritz values θ, each at least the eigenvalue in its place; shape (k,)
    vectors: FloatArray  # Ritz vectors w, tangent and orthonormal in the metric; shape (k, n, m)
    # norms of the projected J⁻¹ D²L w − θ w in the metric, within which of θ there is an eigenvalue, for those of the
    # lowest pairs that were examined; shape (j,), j ≤ k
    residuals: FloatArray


def soft_modes(
    point: Point, starts: FloatArray, tolerance: float = 1e-6, below: float = BULK, most: int = 400
) -> SoftModes:
    """Look for the lowest eigenvalues at a point, in the metric J_C or one as strong.

    Starts are tangent vectors, such as `smooth_starts`; shape (b, n, m).  Of multiple eigenvalues b copies can be
    found, and b pairs are improved at a time, or more if more are ``below`` a bound.  Those, and the lowest one, are
    near enough to eigenvalues where their residuals are within the tolerance.  After ``most`` products with the Hessian
    and as many projections pairs are left as they are.
    """
    space, hessian, (n, m) = point.tangent_space, lagrangian_hessian(point), point.vertices.shape
    most = min(most, m * (n - len(space.constraints.pins)) - space.constraints.count)  # no more dimensions than that

    def each(operator: LinearMap, rows: FloatArray) -> FloatArray:
        return np.array([operator(row.reshape(n, m)).ravel() for row in rows]).reshape(rows.shape)

    # a basis that is orthonormal in the metric, J times it, and D²L times it; rows of n·m numbers
    vectors, duals, images = np.empty((3, 0, n * m))
    new = starts[:most].reshape(-1, n * m)
    while True:
        added = each(space.apply, new)
        for _ in range(2):  # what the basis has of new vectors is taken off them; once leaves rounding errors
            part = new @ duals.T
            new, added = new - part @ vectors, added - part @ duals
            squares, turns = np.linalg.eigh(new @ added.T)
            # of squared lengths: vectors that add so little to the others are left out
            kept = squares > 1e-10 * squares.max(initial=0.0)
            turn = (turns[:, kept] / np.sqrt(squares[kept])).T
            new, added = turn @ new, turn @ added
        vectors, duals = np.vstack([vectors, new]), np.vstack([duals, added])
        images = np.vstack([images, each(hessian, new)])
        # Ritz values, ascending, and the vectors' coefficients as rows; none points away from the first start
        projected = vectors @ images.T
        values, turns = np.linalg.eigh(0.5 * (projected + projected.T))
        turns = (turns * np.copysign(1.0, turns[:1])).T
        wanted = max(1, int(np.count_nonzero(values < below)))
        count = max(len(starts), wanted)
        # what the lowest pairs leave of (D²L − θ J) w
        forces = turns[:count] @ images - values[:count, None] * (turns[:count] @ duals)
        new = each(lambda force: space.gradient(force)[0], forces)
        residuals = np.sqrt(np.maximum(0.0, dot(new, forces)))
        # residuals that are shorter than the largest Ritz value by so much are rounding errors
        far = residuals > max(tolerance, 1e-10 * np.abs(values).max(initial=0.0))
        if len(vectors) >= most or not far[:wanted].any():
            return SoftModes(values, np.reshape(turns @ vectors, (-1, n, m)), residuals)
        new = (new[far] / residuals[far, None])[: most - len(vectors)]


def smooth_starts(point: Point, rng: np.random.Generator, count: int = 8) -> FloatArray:
    """Gradients of random forces, in which soft modes have a large part on every mesh; shape (count, n, m)."""
    forces = rng.normal(size=(count, *point.vertices.shape))
    return np.stack([point.tangent_space.gradient(force)[0] for force in forces])
