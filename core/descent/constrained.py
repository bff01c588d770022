"""The feasible geometry: lengths and barycenter are prescribed, and (42) of [RS21] leads back to them after a step."""

from dataclasses import dataclass

import numpy as np

from ..checks import check_fields
from ..curve import Curve
from ..errors import OptionError
from ..metrics import InnerProduct
from ..saddle import TangentSpace
from ..types import FloatArray
from .problem import Point, Problem


@dataclass(frozen=True)
class Constrained:
    """The manifold {Φ = 0}.

    Parameters
    ----------
    tolerance
        Of lengths, a relative error, and of barycenters: far below any gap that can be proved.
    max_iterations
        Of the modified Newton method (42), and of Newton's for what it leaves over.
    small
        Change of an edge vector, relative to its length, up to which `TangentSpace.restoration` is as good as the
        shortest way back in the metric, and far cheaper.  Larger corrections should know where other strands are, not
        turn edges that are much shorter than others, and not cost the energy the step has gained.
    contraction
        Least rate of both; where it is slower, a shorter step is cheaper than more iterations.
    """

    tolerance: float = 1e-11
    max_iterations: int = 15
    small: float = 1e-3
    contraction: float = 0.6
    prescribes = True

    def __post_init__(self) -> None:
        check_fields(
            self, tolerance=(0.0, 1.0), max_iterations=(0, np.inf), small=(0.0, np.inf), contraction=(0.0, 1.0)
        )

    def value_and_derivative(self, problem: Problem, curve: Curve) -> tuple[float, FloatArray]:
        """The objective alone."""
        return problem.objective.value_and_derivative(curve)

    def tangent_space(self, problem: Problem, curve: Curve, inner: InnerProduct) -> TangentSpace:
        """ker DΦ."""
        return inner.tangent_space(problem.constraints.derivative(curve))

    def residual(self, problem: Problem, curve: Curve) -> FloatArray:
        """Φ."""
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
            if _relative_change(point.curve, correction) > self.small:
                correction = -space.pseudo_inverse(residual)
            vertices = vertices + correction
        return None

    def transport(self, point: Point, u: FloatArray) -> FloatArray:
        """By orthogonal projection."""
        return point.tangent_space.project(u)

    def weighted(self, penalty: float) -> "Constrained":
        """There is no penalty."""
        raise OptionError(f"penalty is {penalty}; the method keeps lengths and has no penalty")


def _relative_change(curve: Curve, u: FloatArray) -> float:
    """max |ΔU_I|/ℓ_I, by how much displacements u turn or stretch an edge."""
    change = u[curve.mesh.heads] - u[curve.mesh.tails]
    return float(np.max(np.linalg.norm(change, axis=1) / curve.edge_lengths))
