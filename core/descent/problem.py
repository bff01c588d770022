"""What is minimised, in which metric, under which constraints: values at a point are computed once, when asked for."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..collision import FreeMotion, free_motion
from ..constraints import ConstraintDerivative, Constraints
from ..curve import Curve, Mesh
from ..energies import Objective
from ..metrics import Metric
from ..saddle import SaddleSolver
from ..types import FloatArray
from ..units import Units


@dataclass(frozen=True, eq=False)
class Problem:
    """One minimisation: the objective, the metric, the constraints and the units it is solved in."""

    mesh: Mesh
    objective: Objective
    metric: Metric
    constraints: Constraints
    units: Units

    def at(self, vertices: FloatArray) -> "Point":
        """The point with these vertices, in the program's units."""
        return Point(self, vertices)

    @property
    def certifiable(self) -> bool:
        """Whether contact is tested: in R² and R³; in more dimensions nothing is knotted."""
        return len(self.units.offset) <= 3

    def free_motion(self, start: FloatArray, end: FloatArray) -> FreeMotion:
        """How far the straight motion is proved free of contact, in the user's rounded coordinates."""
        if not self.certifiable:
            return FreeMotion(1.0, None)
        return free_motion(self.mesh, self.units.to_user(start), self.units.to_user(end))


class Point:
    """A polygon with the values that methods ask for, each computed at most once."""

    def __init__(self, problem: Problem, vertices: FloatArray) -> None:
        self.problem = problem
        self.vertices = vertices

    @cached_property
    def curve(self) -> Curve:
        """The polygon in the program's units."""
        return Curve(self.vertices, self.problem.mesh)

    @cached_property
    def _energy_and_derivative(self) -> tuple[float, FloatArray]:
        return self.problem.objective.value_and_derivative(self.curve)

    @property
    def energy(self) -> float:
        """The objective E."""
        return self._energy_and_derivative[0]

    @property
    def derivative(self) -> FloatArray:
        """DE, shape (n, m)."""
        return self._energy_and_derivative[1]

    @cached_property
    def residual(self) -> FloatArray:
        """Φ, shape (n + m,)."""
        return self.problem.constraints.residual(self.curve)

    @cached_property
    def saddle(self) -> SaddleSolver:
        """The factorised system (41) of [RS21]."""
        return SaddleSolver(self.problem.metric.matrix(self.curve), ConstraintDerivative.at(self.curve))

    @cached_property
    def _gradient_and_multipliers(self) -> tuple[FloatArray, FloatArray]:
        return self.saddle.gradient(self.derivative)

    @property
    def gradient(self) -> FloatArray:
        """Projected gradient u, shape (n, m)."""
        return self._gradient_and_multipliers[0]

    @property
    def multipliers(self) -> FloatArray:
        """Lagrange multipliers λ, shape (n + m,)."""
        return self._gradient_and_multipliers[1]

    @cached_property
    def gradient_norm(self) -> float:
        """Metric norm of the projected gradient: ⟨u, u⟩ = DE·u, because C u = 0."""
        return float(np.sqrt(max(0.0, np.sum(self.gradient * self.derivative))))
