"""What is minimised, in which metric, under which constraints: values at a point are computed once, when asked for."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..collision import FreeMotion, Limit, free_motion
from ..constraints import ConstraintDerivative, Constraints
from ..curve import Curve, Mesh
from ..energies import Objective
from ..metrics import Metric
from ..saddle import SaddleSolver
from ..types import FloatArray
from ..units import Units


@dataclass(frozen=True, eq=False)
class Problem:
    """One minimisation: the objective, the metric, the constraints and the units it is solved in.

    Attributes
    ----------
    constraints
        Prescribed lengths and barycenter.
    penalty
        None for the constrained problem.  Otherwise α of Section 6.4 of [RS21]: lengths cost α Σ ℓ⁰ log(ℓ/ℓ⁰)² instead
        of being prescribed, and the metric is J + α DΦᵀ I_{L²} DΦ.
    extended
        Whether a penalised problem extends its metric so (footnote 8: not on L²).
    """

    mesh: Mesh
    objective: Objective
    metric: Metric
    constraints: Constraints
    units: Units
    penalty: float | None = None
    extended: bool = True

    def at(self, vertices: FloatArray) -> "Point":
        """The point with these vertices, in the program's units."""
        return Point(self, vertices, self.units.to_user(vertices))

    def at_curve(self, curve: Curve) -> "Point":
        """The point of a curve in the user's units, whose coordinates are kept to the last digit."""
        return Point(self, self.units.from_user(curve.vertices), curve.vertices)

    @property
    def certifiable(self) -> bool:
        """Whether contact is tested: in R² and R³; in more dimensions nothing is knotted."""
        return len(self.units.offset) <= 3

    def free_motion(self, start: FloatArray, end: FloatArray) -> FreeMotion:
        """How far a straight motion in the user's units, both (n, m), is proved free of contact."""
        if not self.certifiable:
            return FreeMotion(1.0, None, Limit.UNTESTED)
        return free_motion(self.mesh, start, end)

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        """The objective, with the penalty if there is one, and its derivative, shape (n, m)."""
        energy, derivative = self.objective.value_and_derivative(curve)
        if self.penalty is None:
            return energy, derivative
        stretch = np.log(curve.edge_lengths / self.constraints.lengths)
        weights = self.penalty * self.constraints.lengths
        pull = ConstraintDerivative.of_lengths(curve).apply_transpose(2.0 * weights * stretch)
        return energy + float(weights @ stretch**2), derivative + pull

    def saddle(self, curve: Curve) -> SaddleSolver:
        """The factorised system (41) of [RS21] at a curve."""
        matrix = self.metric.matrix(curve)
        if self.penalty is None:
            return SaddleSolver(matrix, self.constraints.derivative(curve))
        weights = (self.penalty if self.extended else 0.0) * self.constraints.lengths
        return SaddleSolver(matrix, ConstraintDerivative.of_lengths(curve), weights)


NEGLIGIBLE = 1e-8  # displacement, in the program's units, that changes no energy visibly


class Point:
    """A polygon with the values that methods ask for, each computed at most once.

    Parameters
    ----------
    problem
        What is solved.
    vertices
        In the program's units; shape (n, m).
    placed
        The same in the user's, rounded: the doubles that proofs are about and that are written; shape (n, m).
    """

    def __init__(self, problem: Problem, vertices: FloatArray, placed: FloatArray) -> None:
        self.problem = problem
        self.vertices = vertices
        self.placed = placed

    def within(self, problem: Problem) -> "Point":
        """The same polygon in another problem on the same mesh."""
        return self if problem is self.problem else Point(problem, self.vertices, self.placed)

    @cached_property
    def curve(self) -> Curve:
        """The polygon in the program's units."""
        return Curve(self.vertices, self.problem.mesh)

    @cached_property
    def _energy_and_derivative(self) -> tuple[float, FloatArray]:
        return self.problem.value_and_derivative(self.curve)

    @property
    def energy(self) -> float:
        """The objective E."""
        return self._energy_and_derivative[0]

    @property
    def derivative(self) -> FloatArray:
        """DE, shape (n, m)."""
        return self._energy_and_derivative[1]

    @property
    def energy_as_placed(self) -> float:
        """The objective of the rounded coordinates that users get, which far from the origin are another curve's."""
        rounded = self.problem.units.from_user(self.placed)
        same = np.max(np.abs(rounded - self.vertices)) <= NEGLIGIBLE
        return self.energy if same else self.problem.at(rounded).energy

    @cached_property
    def residual(self) -> FloatArray:
        """Φ, shape (n + m,)."""
        return self.problem.constraints.residual(self.curve)

    @cached_property
    def saddle(self) -> SaddleSolver:
        """The factorised system (41) of [RS21]."""
        return self.problem.saddle(self.curve)

    @cached_property
    def _gradient_and_multipliers(self) -> tuple[FloatArray, FloatArray]:
        return self.saddle.gradient(self.derivative)

    @property
    def gradient(self) -> FloatArray:
        """Projected gradient u (penalised problems: gradient), shape (n, m)."""
        return self._gradient_and_multipliers[0]

    @property
    def multipliers(self) -> FloatArray:
        """Lagrange multipliers λ, shape (n + m,); 0 where lengths are penalised."""
        if self.problem.penalty is not None:
            return np.zeros(len(self.vertices))
        return self._gradient_and_multipliers[1]

    @cached_property
    def gradient_norm(self) -> float:
        """Metric norm of the projected gradient: ⟨u, u⟩ = DE·u, because C u = 0."""
        return float(np.sqrt(max(0.0, np.sum(self.gradient * self.derivative))))

    def lagrangian_derivative(self, multipliers: FloatArray) -> FloatArray:
        """DE − DΦᵀ λ for given multipliers, shape (n, m): the covector whose zeros are critical points."""
        return self.derivative - self.saddle.constraints.apply_transpose(multipliers)
