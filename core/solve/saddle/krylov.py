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

LinearMap = Callable[[FloatArray], FloatArray]
# From a residual r, and what iterations so far took off the squared norm of the error, to z near the operator's inverse
# times r, and the residual to go on with: r itself, or r without a part that is of no consequence.  None is enough.
Preconditioner = Callable[[FloatArray, list[float]], tuple[FloatArray, FloatArray] | None]


def conjugate_gradients(
    operator: LinearMap, precondition: Preconditioner, right: FloatArray, most: int, *, indefinite: bool = False
) -> FloatArray:
    """Solve ``operator`` x = ``right``, for arrays of any shape and a symmetric positive definite operator.

    The preconditioner may vary from iteration to iteration (Polak and Ribière's formula), and says when to stop.  A
    LinAlgError says if the operator is not positive definite, or ``most`` iterations do not suffice.  Where it may be
    indefinite, as a second derivative is, neither is an error (Steihaug's rule): on a direction of negative curvature
    the iteration ends with what it has, the first time with that direction itself, and so does the last iteration.
    """
    x, direction, rho = np.zeros_like(right), np.zeros_like(right), 1.0
    r = last = right
    decreases: list[float] = []
    for _ in range(most + (not indefinite)):  # whether the last iteration was enough shows in the next one
        check_time()
        preconditioned = precondition(r, decreases)
        if preconditioned is None:
            return x
        z, r = preconditioned
        direction = z + float(np.sum(z * (r - last))) / rho * direction
        rho, last = float(np.sum(r * z)), r
        if rho == 0.0:
            return x
        image = operator(direction)
        curvature, slope = float(np.sum(direction * image)), float(np.sum(r * direction))
        if not curvature > 0.0:
            if indefinite:
                return x if decreases else direction
            raise np.linalg.LinAlgError("matrix is not positive definite: a direction has no positive curvature")
        x = x + slope / curvature * direction
        r = r - slope / curvature * image
        decreases.append(slope**2 / curvature)
    if indefinite:
        return x
    raise np.linalg.LinAlgError(f"conjugate gradients need more than {most} iterations")


def stopping(solve: LinearMap, enough: Callable[[float, float], bool]) -> Preconditioner:
    """A fixed preconditioner that stops by rᵀz, the square of the preconditioned residual, and that of the solution."""

    def precondition(r: FloatArray, decreases: list[float]) -> tuple[FloatArray, FloatArray] | None:
        z = solve(r)
        return None if enough(float(np.sum(r * z)), sum(decreases)) else (z, r)

    return precondition


def relative(solve: LinearMap, tolerance: float) -> Preconditioner:
    """One that stops when the residual is small against the solution."""
    return stopping(solve, lambda rho, square: rho <= tolerance**2 * square)


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
        self._model, self.constraints = model, constraints
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

        multipliers = self._solve_schur(self.constraints.apply(free), stopping(self._near_inverse, enough))
        return self._model.solve(r - self.constraints.apply_transpose(multipliers)), multipliers

    def square(self, r: FloatArray) -> float:
        """rᵀ M⁻¹ r."""
        return float(np.sum(r * self._model.solve(r)))

    def shortest(self, xi: FloatArray, tolerance: float) -> FloatArray:
        """The u of least norm in M with C u = ξ, up to a relative error; shapes (rows of C,) -> (n, m)."""
        multipliers = self._solve_schur(xi, relative(self._near_inverse, tolerance))
        return self._model.solve(self.constraints.apply_transpose(multipliers))

    def _solve_schur(self, right: FloatArray, precondition: Preconditioner) -> FloatArray:
        c = self.constraints
        schur = lambda multipliers: c.apply(self._model.solve(c.apply_transpose(multipliers)))  # noqa: E731
        return conjugate_gradients(schur, precondition, right, 500)

    def _near_inverse(self, residual: FloatArray) -> FloatArray:
        c = self.constraints
        return np.concatenate([self._tension(c.tensions(residual))[c.edges], self._held @ residual[len(c.edges) :]])
