"""Tangent spaces of inner products of which only products are at hand: the system (41) of [RS21] by projected CG.

Conjugate gradients on ker C, flexible because their constraint preconditioner is itself solved only loosely.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from ...base.types import FloatArray
from ...curve import Curve
from ..constraints import ConstraintDerivative, Constraints
from .krylov import ROUNDING, ConstraintPreconditioner, Model, conjugate_gradients, relative
from .models import vanishing_at
from .tangent_space import Applied, TangentSpace


@dataclass(frozen=True)
class Tolerances:
    """How exactly systems are solved; relative errors in the norm of the inner product, in (0, 1]."""

    gradient: float = 1e-2  # of projected gradients
    correction: float = 1e-1  # of pseudo-inverses, and of the correction that a projection makes
    preconditioner: float = 1e-2  # part of a preconditioned residual that is not tangential
    feasibility: float = 1e-10  # of C u = ξ
    max_iterations: int = 500  # of one system

    @classmethod
    def of_norms(cls, accuracy: float = 1e-4) -> "Tolerances":
        """Those at which norms of projected gradients, exact to half the square of the errors, have an accuracy."""
        error = math.sqrt(0.5 * accuracy)
        return cls(gradient=error, preconditioner=error)


class WithModel(Applied, Protocol):
    """A Gram matrix A of which products are known, and a model that is cheaply inverted."""

    @property
    def model(self) -> Model:
        """M, spectrally equivalent to A."""


class IterativeTangentSpace(TangentSpace):
    """Constraints of full rank, or any with weights; LinAlgError unless A is definite and iterations suffice."""

    def __init__(
        self,
        inner: WithModel,
        constraints: ConstraintDerivative,
        tolerances: Tolerances,
        weights: FloatArray | None = None,
    ) -> None:
        super().__init__(inner, constraints, weights)
        self._tolerances = tolerances
        self._model = vanishing_at(constraints.pins, inner.model, constraints.mesh)

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
        negligible = ROUNDING**2 * preconditioner.square(r)

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
