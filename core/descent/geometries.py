"""The sets that iterates lie on: polygons with prescribed lengths, or all polygons, lengths costing a penalty."""

from dataclasses import dataclass, replace

import numpy as np

from ..base import FloatArray, OptionError
from ..curve import Curve, free_edges
from ..solve.constraints import ConstraintDerivative
from ..solve.metrics import InnerProduct
from ..solve.saddle import TangentSpace
from .problem import Point, Problem


@dataclass(frozen=True)
class Constrained:
    """The manifold {Φ = 0}, to which (42) of [RS21] leads back after a step."""

    # of lengths, a relative error, and of barycenters: far below any gap that can be proved
    tolerance: float = 1e-11
    max_iterations: int = 15  # of the modified Newton method (42), and of Newton's for what it leaves over
    # change of an edge vector, relative to its length, up to which `TangentSpace.restoration` is as good as the
    # shortest way back in the metric, and far cheaper. Larger corrections should know where other strands are, not
    # turn edges that are much shorter than others, and not cost the energy the step has gained
    small: float = 1e-3
    # least rate of both; where it is slower, a shorter step is cheaper than more iterations
    contraction: float = 0.6
    prescribes = True

    def value_and_derivative(self, problem: Problem, curve: Curve) -> tuple[float, FloatArray]:
        return problem.objective.value_and_derivative(curve)

    def tangent_space(self, problem: Problem, curve: Curve, inner: InnerProduct) -> TangentSpace:
        return inner.tangent_space(problem.constraints.derivative(curve))

    def residual(self, problem: Problem, curve: Curve) -> FloatArray:
        return problem.constraints.residual(curve)

    def retract(self, base: Point, vertices: FloatArray, level: FloatArray, space: TangentSpace) -> Point | None:
        """Find Q near ``vertices`` with Φ(Q) = ``level`` by Q ← Q − C(P)^† (Φ(Q) − level), P the base point: (42).

        Once corrections are small the derivative is that at Q and the pseudo-inverse one that is cheap, by which the
        residual vanishes quadratically.  There is always a correction: many short steps, each within the tolerance,
        would drift away together, and what lengths gain or lose by that is energy which searches take for the step's.
        None if the residual does not contract: the step was too long.
        """
        last = np.inf
        for corrections in range(self.max_iterations):
            point = base.problem.at(vertices)
            if not point.nondegenerate:
                return None
            residual = point.residual - level
            error = base.problem.constraints.error(point.curve.mesh, residual)
            if error <= self.tolerance and corrections:
                return point
            if not error <= self.contraction * last:
                return None
            last = error
            correction = space.restoration(base.problem.constraints, point.curve, residual)
            if correction is not None:  # by how much it turns or stretches edges
                change = np.linalg.norm(point.curve.mesh.changes(correction), axis=1)
            if correction is None or np.max(change / point.curve.edge_lengths) > self.small:
                correction = -space.pseudo_inverse(residual)
            vertices = vertices + correction
        return None

    def transport(self, point: Point, u: FloatArray) -> FloatArray:
        return point.tangent_space.project(u)

    def weighted(self, penalty: float) -> "Constrained":
        raise OptionError(f"penalty is {penalty}; the method keeps lengths and has no penalty")


@dataclass(frozen=True)
class Penalised:
    """All polygons that are where their pins are; lengths cost α Σ ℓ⁰ log(ℓ/ℓ⁰)², as in Section 6.4 of [RS21].

    The metric is J + α DΦᵀ I_{L²} DΦ, or J alone where footnote 8 leaves the extension out.
    """

    penalty: float = 1000.0  # α
    prescribes = False

    def value_and_derivative(self, problem: Problem, curve: Curve) -> tuple[float, FloatArray]:
        energy, derivative = problem.objective.value_and_derivative(curve)
        targets = problem.constraints.lengths
        stretch = np.log(curve.edge_lengths / targets)
        weights = self.penalty * targets
        pull = ConstraintDerivative.of_lengths(curve).apply_transpose(2.0 * weights * stretch)
        return energy + float(weights @ stretch**2), derivative + pull

    def tangent_space(self, problem: Problem, curve: Curve, inner: InnerProduct) -> TangentSpace:
        """The whole space, but for pins."""
        penalty = self.penalty if problem.metric.extends_penalty else 0.0
        constraints = problem.constraints
        rows = ConstraintDerivative.of_lengths(curve, constraints.pins.vertices)
        return inner.tangent_space(replace(rows, symmetry=constraints.symmetry), penalty * constraints.lengths)

    def residual(self, problem: Problem, curve: Curve) -> FloatArray:
        """Every polygon is allowed: 0."""
        return np.zeros(len(free_edges(curve.mesh, problem.constraints.pins.vertices)))

    def retract(self, base: Point, vertices: FloatArray, level: FloatArray, space: TangentSpace) -> Point | None:
        """The vertices as they are, unless an edge has no length."""
        point = base.problem.at(vertices)
        return point if point.nondegenerate else None

    def transport(self, point: Point, u: FloatArray) -> FloatArray:
        """There is only one tangent space."""
        return u

    def weighted(self, penalty: float) -> "Penalised":
        return replace(self, penalty=penalty)
