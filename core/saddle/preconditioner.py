"""Constraint preconditioners: the saddle-point system (41) of [RS21] with a model M in place of J.

Gould, Hribar and Nocedal, On the solution of equality constrained quadratic programming problems arising in
optimization, SIAM J. Sci. Comput. 23 (2001).
"""

from collections.abc import Callable
from typing import Protocol

import numpy as np

from ..constraints import ConstraintDerivative
from ..types import FloatArray
from .krylov import LinearMap, conjugate_gradients

ROUNDING = 1e-12  # relative to all of a covector, below which its tangential part is rounding
MAX_ITERATIONS = 500


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
        """Solve for the right side (r, 0): u, shape (n, m), and λ.

        Of what remains normal the length is at most ``tolerance`` times that of u, in the norm of M.
        """
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
        return conjugate_gradients(self._schur, self._near_inverse, right, enough, MAX_ITERATIONS)

    def _schur(self, multipliers: FloatArray) -> FloatArray:
        c = self.constraints
        return c.apply(self._model.solve(c.apply_transpose(multipliers)))

    def _near_inverse(self, residual: FloatArray) -> FloatArray:
        c = self.constraints
        return np.concatenate([self._tension(c.tensions(residual))[c.edges], self._held @ residual[len(c.edges) :]])
