"""What methods ask of a tangent space; `dense` and `sparse` are ways to answer."""

from abc import ABC, abstractmethod

import numpy as np

from ..constraints import ConstraintDerivative, Constraints
from ..curve import Curve
from ..types import FloatArray
from .restoration import euclidean_correction


class TangentSpace(ABC):
    """The tangent space {u : C u = 0, u = 0 at pins}, C = DΦ(P), with an inner product J on all of R^(n·m).

    All of it rests on the saddle-point system (41) of [RS21],

        [ J  Cᵀ ] (u)   (η)
        [ C  0  ] (λ) = (ξ),

    with the rows and columns of pins left out, for three right sides: (DE, 0) gives the projected gradient, (0, ξ) the
    pseudo-inverse C^† ξ, (J v, 0) the projection of v.
    """

    def __init__(self, constraints: ConstraintDerivative) -> None:
        self.constraints = constraints

    @abstractmethod
    def solve(self, eta: FloatArray | None, xi: FloatArray | None) -> tuple[FloatArray, FloatArray]:
        """Solve for u, shape (n, m), and λ, shape (rows of C,); None stands for a zero right side."""

    @abstractmethod
    def apply(self, u: FloatArray) -> FloatArray:
        """J u, shape (n, m)."""

    def gradient(self, derivative: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Projected gradient u, shape (n, m), and multipliers λ, shape (rows of C,), of a derivative, shape (n, m)."""
        return self.solve(derivative, None)

    def pseudo_inverse(self, xi: FloatArray) -> FloatArray:
        """C^† ξ, the shortest u with C u = ξ; shapes (rows of C,) -> (n, m)."""
        return self.solve(None, xi)[0]

    def restoration(self, constraints: Constraints, curve: Curve, residual: FloatArray) -> FloatArray | None:
        """A short u with DΦ u = −Φ at a curve near by, where a small residual Φ is left: Newton's method; shape (n, m).

        By default the shortest in the Euclidean metric, at O(n); None if there is none so cheap.
        """
        return euclidean_correction(constraints, curve, residual)

    def project(self, u: FloatArray) -> FloatArray:
        """The orthogonal projection of u, which vanishes at pins; shape (n, m)."""
        return self.solve(self.apply(u), None)[0]

    def norm(self, u: FloatArray) -> float:
        """√⟨u, J u⟩."""
        return float(np.sqrt(max(0.0, np.sum(u * self.apply(u)))))


class WholeSpace(TangentSpace):
    """All of R^(n·m), nothing being constrained but pins, with J + Cᵀ w C: how Section 6.4 of [RS21] penalises lengths.

    The weights w ≥ 0 have shape (rows of C,).
    """

    def __init__(self, constraints: ConstraintDerivative, weights: FloatArray) -> None:
        super().__init__(constraints)
        self.weights = weights

    @abstractmethod
    def riesz(self, eta: FloatArray) -> FloatArray:
        """(J + Cᵀ w C)⁻¹ η, shape (n, m)."""

    def solve(self, eta: FloatArray | None, xi: FloatArray | None) -> tuple[FloatArray, FloatArray]:
        """The same without constraints: ξ is of no consequence, multipliers are 0."""
        u = np.zeros(self.constraints.shape) if eta is None else self.riesz(eta)
        return u, np.zeros(self.constraints.count)

    def project(self, u: FloatArray) -> FloatArray:
        return u
