"""Tangent spaces of inner products of which only products are at hand: the system (41) of [RS21] by projected CG.

Conjugate gradients on ker C, flexible because their constraint preconditioner is itself solved only loosely.  Such
preconditioners solve (41) with a model M in place of J: Gould, Hribar and Nocedal, On the solution of equality
constrained quadratic programming problems arising in optimization, SIAM J. Sci. Comput. 23 (2001).
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from ...base import FloatArray, IntArray, check_time
from ...curve import Curve, Mesh, holds
from ..constraints import ConstraintDerivative, Constraints
from .models import Model
from .tangent_space import LinearMap, TangentSpace

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
            return rho <= max(tolerance**2 * (total - normal), Tolerances.rounding**2 * total)

        multipliers = self._solve_schur(self.constraints.apply(free), stopping(self._near_inverse, enough))
        return self._model.solve(r - self.constraints.apply_transpose(multipliers)), multipliers

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


@dataclass(frozen=True)
class Tolerances:
    """How exactly systems are solved; relative errors in the norm of the inner product, in (0, 1]."""

    gradient: float = 1e-2  # of projected gradients
    correction: float = 1e-1  # of pseudo-inverses, and of the correction that a projection makes
    preconditioner: float = 1e-2  # part of a preconditioned residual that is not tangential
    feasibility: float = 1e-10  # of C u = ξ
    max_iterations: int = 500  # of one system
    rounding: ClassVar[float] = 1e-12  # relative to all of a covector, below which its tangential part is that

    @classmethod
    def of_norms(cls, accuracy: float = 1e-4) -> "Tolerances":
        """Those at which norms of projected gradients, exact to half the square of the errors, have an accuracy."""
        error = math.sqrt(0.5 * accuracy)
        return cls(gradient=error, preconditioner=error)


class IterativeTangentSpace(TangentSpace):
    """Constraints of full rank, or any with weights; LinAlgError unless A is definite and iterations suffice."""

    def __init__(
        self,
        product: LinearMap,
        model: Model,
        constraints: ConstraintDerivative,
        tolerances: Tolerances,
        weights: FloatArray | None = None,
    ) -> None:
        super().__init__(product, constraints, weights)
        self._tolerances = tolerances
        pins = constraints.pins
        self._model = PinnedModel(model, constraints.mesh, pins) if len(pins) else model

    @cached_property
    def _preconditioner(self) -> ConstraintPreconditioner:
        return ConstraintPreconditioner(self._model, self.constraints)

    def solve(self, eta: FloatArray | None, xi: FloatArray | None) -> tuple[FloatArray, FloatArray]:
        """Solve for each of the two right sides, to its own tolerance."""
        u, multipliers = np.zeros(self.constraints.shape), np.zeros(self.constraints.count)
        if self.weights is not None:  # preconditioned by the model of J
            precondition = relative(self._model.solve, self._tolerances.gradient)
            right = u if eta is None else eta
            return conjugate_gradients(self.apply, precondition, right, self._tolerances.max_iterations), multipliers
        if eta is not None:
            found, multipliers = self._descend(eta, self._tolerances.gradient, 0.0)
            found = self._feasible(found, np.zeros(self.constraints.count))
            # of the tangent vector found the multiple with η·u = ⟨u, u⟩, which has the square of its error
            square = float(np.sum(found * self.apply(found)))
            u = found * (float(np.sum(eta * found)) / square) if square > 0.0 else found
        if xi is not None:  # the shortest in the model, then the way from there along ker C to the shortest in J
            start = self._preconditioner.shortest(xi, self._tolerances.preconditioner)
            force = self.apply(start)
            found, more = self._descend(-force, self._tolerances.correction, float(np.sum(start * force)))
            u, multipliers = u + self._feasible(start + found, xi), multipliers + more
        return u, multipliers

    def project(self, u: FloatArray) -> FloatArray:
        """The orthogonal projection of u: less the shortest correction, a small one where u is nearly tangent."""
        if self.weights is not None:
            return u
        return self.constraints.symmetry.mean(u) - self.pseudo_inverse(self.constraints.apply(u))

    def restoration(self, constraints: Constraints, curve: Curve, residual: FloatArray) -> FloatArray:
        """The shortest in the model, exact enough for quadratic convergence; Euclidean ones turn fine edges too far."""
        here = ConstraintPreconditioner(self._model, constraints.derivative(curve))
        return here.shortest(-residual, max(float(np.max(np.abs(residual))), 1e-4))

    def _feasible(self, u: FloatArray, xi: FloatArray) -> FloatArray:
        """The u nearest in the model with C u = ξ."""
        defect = self.constraints.apply(u) - xi
        return u - self._preconditioner.shortest(defect, self._tolerances.feasibility)

    def _descend(self, r: FloatArray, tolerance: float, start: float) -> tuple[FloatArray, FloatArray]:
        """The u in ker C of least ½ ⟨u, J u⟩ − r·u, tangent up to the preconditioner's tolerance, and its multipliers.

        The error that is left is estimated by the decrease in the last quarter of the iterations (Hestenes and
        Stiefel), relative to the norm of the solution, of which the square was ``start`` before.
        """
        c, preconditioner = self.constraints, self._preconditioner
        multipliers = np.zeros(c.count)
        negligible = Tolerances.rounding**2 * float(np.sum(r * self._model.solve(r)))

        def precondition(r: FloatArray, decreases: list[float]) -> tuple[FloatArray, FloatArray] | None:
            nonlocal multipliers
            window = max(2, len(decreases) // 4)
            square = abs(start - sum(decreases))
            if len(decreases) > window and sum(decreases[-window:]) <= max(tolerance**2 * square, negligible):
                return None
            z, change = preconditioner.project(r, self._tolerances.preconditioner)
            multipliers = multipliers + change
            return z, r - c.apply_transpose(change)  # without its normal part r does not pull iterates off ker C

        return conjugate_gradients(self.apply, precondition, r, self._tolerances.max_iterations), multipliers
