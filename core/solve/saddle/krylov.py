"""Preconditioned conjugate gradients for systems of which only products are at hand, and constraint preconditioners.

The latter solve the saddle-point system (41) of [RS21] with a model M in place of J: Gould, Hribar and Nocedal, On the
solution of equality constrained quadratic programming problems arising in optimization, SIAM J. Sci. Comput. 23 (2001).
"""

from collections.abc import Callable
from typing import Protocol

import numpy as np

from ...base.deadline import check_time
from ...base.types import FloatArray
from ..constraints import ConstraintDerivative

ROUNDING = 1e-12  # relative to all of a covector, below which its tangential part is rounding
MAX_ITERATIONS = 500

LinearMap = Callable[[FloatArray], FloatArray]


def conjugate_gradients(
    operator: LinearMap,
    precondition: LinearMap,
    right: FloatArray,
    enough: Callable[[float, float], bool],
    max_iterations: int,
) -> FloatArray:
    """Solve ``operator`` x = ``right``, for arrays of any shape.

    The operator and ``precondition``, near its inverse, are symmetric and positive definite.  ``enough`` says whether
    to stop, from rᵀz, the square of the preconditioned residual, and from xᵀ ``right``, which grows to the squared norm
    of the solution in the operator's inner product.  A LinAlgError says if the operator
    is not positive definite, or the iterations do not suffice.
    """
    x = np.zeros_like(right)
    r, direction, last, square = right.copy(), np.zeros_like(right), 1.0, 0.0
    for _ in range(max_iterations):
        check_time()
        z = precondition(r)
        rho = float(np.sum(r * z))
        if enough(rho, square):
            return x
        direction = z + (rho / last) * direction
        image = operator(direction)
        step = rho / _positive(float(np.sum(direction * image)))
        x += step * direction
        r -= step * image
        square += step * rho
        last = rho
    raise np.linalg.LinAlgError(f"conjugate gradients need more than {max_iterations} iterations")


def relative(tolerance: float) -> Callable[[float, float], bool]:
    """Enough when the residual is small against the solution, both squared."""
    return lambda rho, square: rho <= tolerance**2 * square


def flexible_conjugate_gradients(
    operator: LinearMap,
    precondition: Callable[[FloatArray], tuple[FloatArray, FloatArray]],
    right: FloatArray,
    enough: Callable[[list[float]], bool],
    max_iterations: int,
) -> FloatArray:
    """The same with a preconditioner that varies from iteration to iteration (Polak and Ribière's formula).

    ``precondition`` leads from r to z and the residual to go on with: r itself, or r without a part that is of no
    consequence.  ``enough`` says whether to stop, from the decrease of ½ xᵀ A x − xᵀ ``right`` in all iterations so
    far, twice each: these are what each took off the squared norm of the error.
    """
    x, direction, rho = np.zeros_like(right), np.zeros_like(right), 1.0
    r = last = right
    decreases: list[float] = []
    while not enough(decreases):
        if len(decreases) == max_iterations:
            raise np.linalg.LinAlgError(f"conjugate gradients need more than {max_iterations} iterations")
        check_time()
        z, r = precondition(r)
        direction = z + float(np.sum(z * (r - last))) / rho * direction
        rho, last = float(np.sum(r * z)), r
        if rho == 0.0:
            break
        image = operator(direction)
        curvature, slope = _positive(float(np.sum(direction * image))), float(np.sum(r * direction))
        x = x + slope / curvature * direction
        r = r - slope / curvature * image
        decreases.append(slope**2 / curvature)
    return x


def _positive(curvature: float) -> float:
    if not curvature > 0.0:
        raise np.linalg.LinAlgError("matrix is not positive definite: conjugate gradients met no positive curvature")
    return curvature


class Model(Protocol):
    """An inner product M that is cheaply inverted."""

    def solve(self, f: FloatArray) -> FloatArray:
        """M⁻¹ f; shape (n, k)."""

    def tension(self, tangents: FloatArray) -> LinearMap:
        """A map near the inverse of Σ_k diag(t_k) D M⁻¹ Dᵀ diag(t_k), D the edge differences; (n,) to (n,).

        It leads from changes of edge lengths to tensions that cause them, for t = τ/ℓ of shape (n, m).
        """


class ConstraintPreconditioner:
    """[M Cᵀ; C 0] through the Schur complement S = C M⁻¹ Cᵀ, by conjugate gradients.

    On the lengths S = Σ_k diag(t_k) D M⁻¹ Dᵀ diag(t_k) with t_I = τ_I/ℓ_I, which the model all but inverts.
    """

    def __init__(self, model: Model, constraints: ConstraintDerivative) -> None:
        self._model = model
        self.constraints = constraints
        self._tension = model.tension(constraints.tangents)
        rows = len(constraints.edges)
        forced = [constraints.apply(model.solve(row))[rows:] for row in constraints.border()]
        self._held = np.linalg.inv(np.reshape(forced, (len(forced), len(forced))))

    def project(self, r: FloatArray, tolerance: float) -> tuple[FloatArray, FloatArray]:
        """u, (n, m), and λ for the right side (r, 0); what stays normal is ≤ ``tolerance`` times u in M's norm."""
        free = self._model.solve(r)
        total = float(np.sum(r * free))

        def enough(rho: float, normal: float) -> bool:
            return rho <= max(tolerance**2 * (total - normal), ROUNDING**2 * total)

        multipliers = self._solve_schur(self.constraints.apply(free), enough)
        return self._model.solve(r - self.constraints.apply_transpose(multipliers)), multipliers

    def square(self, r: FloatArray) -> float:
        """rᵀ M⁻¹ r."""
        return float(np.sum(r * self._model.solve(r)))

    def shortest(self, xi: FloatArray, tolerance: float) -> FloatArray:
        """The u of least norm in M with C u = ξ, up to a relative error; shapes (rows of C,) -> (n, m)."""
        multipliers = self._solve_schur(xi, lambda rho, square: rho <= tolerance**2 * square)
        return self._model.solve(self.constraints.apply_transpose(multipliers))

    def _solve_schur(self, right: FloatArray, enough: Callable[[float, float], bool]) -> FloatArray:
        c = self.constraints

        def schur(multipliers: FloatArray) -> FloatArray:
            return c.apply(self._model.solve(c.apply_transpose(multipliers)))

        def near_inverse(residual: FloatArray) -> FloatArray:
            return np.concatenate([self._tension(c.tensions(residual))[c.edges], self._held @ residual[len(c.edges) :]])

        return conjugate_gradients(schur, near_inverse, right, enough, MAX_ITERATIONS)
