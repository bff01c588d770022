"""The infeasible geometry of Section 6.4 of [RS21]: E_α = E + α ∫ log(|γ'|/L)² L dt, without constraints."""

from dataclasses import dataclass, replace

import numpy as np

from ..checks import check_fields
from ..constraints import ConstraintDerivative
from ..curve import Curve
from ..metrics import InnerProduct
from ..saddle import TangentSpace
from ..types import FloatArray
from .problem import Point, Problem


@dataclass(frozen=True)
class Penalised:
    """All polygons; lengths cost α Σ ℓ⁰ log(ℓ/ℓ⁰)².

    The metric is J + α DΦᵀ I_{L²} DΦ, or J alone where footnote 8 leaves the extension out.

    Parameters
    ----------
    penalty
        α.

    Raises
    ------
    OptionError
        If α is not a finite positive number.
    """

    penalty: float = 1000.0
    prescribes = False

    def __post_init__(self) -> None:
        check_fields(self, penalty=(0.0, np.inf))

    def value_and_derivative(self, problem: Problem, curve: Curve) -> tuple[float, FloatArray]:
        """E_α and its derivative."""
        energy, derivative = problem.objective.value_and_derivative(curve)
        targets = problem.constraints.lengths
        stretch = np.log(curve.edge_lengths / targets)
        weights = self.penalty * targets
        pull = ConstraintDerivative.of_lengths(curve).apply_transpose(2.0 * weights * stretch)
        return energy + float(weights @ stretch**2), derivative + pull

    def tangent_space(self, problem: Problem, curve: Curve, inner: InnerProduct) -> TangentSpace:
        """The whole space."""
        penalty = self.penalty if problem.metric.extends_penalty else 0.0
        rows = ConstraintDerivative.of_lengths(curve)
        return inner.whole_space(rows, penalty * problem.constraints.lengths)

    def residual(self, problem: Problem, curve: Curve) -> FloatArray:
        """Every polygon is allowed: 0."""
        return np.zeros(curve.mesh.edges)

    def retract(self, base: Point, vertices: FloatArray, level: FloatArray, space: TangentSpace) -> Point | None:
        """The vertices as they are, unless an edge has no length."""
        point = base.problem.at(vertices)
        return point if point.nondegenerate else None

    def transport(self, point: Point, u: FloatArray) -> FloatArray:
        """There is only one tangent space."""
        return u

    def weighted(self, penalty: float) -> "Penalised":
        """The same with another α."""
        return replace(self, penalty=penalty)
