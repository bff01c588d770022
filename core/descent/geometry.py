"""The set that iterates lie on: polygons of prescribed lengths, or, in a subclass, of lengths that cost energy."""

from dataclasses import dataclass

from ..base import FloatArray
from ..curve import Curve
from ..energies import Objective
from ..solve.constraints import Constraints
from ..solve.metrics import InnerProduct, Metric
from ..solve.saddle import TangentSpace


@dataclass(frozen=True)
class Geometry:
    """The manifold {Φ = 0}, its tangent spaces, and how `Point.retract` leads back to it by (42) of [RS21]."""

    penalty: float | None = None  # α, what errors of lengths cost; None where lengths are prescribed
    # of lengths, a relative error, and of barycenters: far below any gap that can be proved
    tolerance: float = 1e-11
    max_iterations: int = 15  # of the modified Newton method (42), and of Newton's for what it leaves over
    # change of an edge vector, relative to its length, up to which `TangentSpace.restoration` is as good as the
    # shortest way back in the metric, and far cheaper. Larger corrections should know where other strands are, not
    # turn edges that are much shorter than others, and not cost the energy the step has gained
    small: float = 1e-3
    # least rate of both; where it is slower, a shorter step is cheaper than more iterations
    contraction: float = 0.6

    @property
    def prescribes(self) -> bool:
        """Whether lengths are prescribed, so that there are multipliers and a residual."""
        return self.penalty is None

    def value_and_derivative(
        self, objective: Objective, constraints: Constraints, curve: Curve
    ) -> tuple[float, FloatArray]:
        """What is minimised on the set, and its derivative, shape (n, m)."""
        return objective.value_and_derivative(curve)

    def tangent_space(
        self, constraints: Constraints, curve: Curve, metric: Metric, inner: InnerProduct
    ) -> TangentSpace:
        """Where directions at a curve lie, with the inner product there of a metric."""
        return inner.tangent_space(constraints.derivative(curve))

    def residual(self, constraints: Constraints, curve: Curve) -> FloatArray:
        """How far a curve is from the set; shape (rows of the constraints,)."""
        return constraints.residual(curve)
