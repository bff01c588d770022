"""What is minimised, in which metric, on which set: values at a point are computed once, on demand."""

from collections.abc import Iterable
from copy import copy
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Protocol

import numpy as np

from ..base import FloatArray, OptionError, check_time
from ..collision import FreeMotion, rope_motion
from ..curve import Curve, Mesh, Obstacle, Pins
from ..curve.symmetry import NO_SYMMETRY, Symmetry
from ..energies import Objective
from ..energies.pull import Pull
from ..energies.rope import Rope
from ..solve.constraints import Barycenters, Constraints
from ..solve.metrics import InnerProduct, Metric, SparseInnerProduct
from ..solve.saddle import TangentSpace
from .geometry import Geometry
from .task import Units


class PairSums(Protocol):
    """How sums over all pairs of edges are evaluated, and which energy and metric they belong to."""

    def on(self, curve: Curve) -> "PairSums":
        """The solver that suits a curve; a CurveError if it has too many vertices."""

    def objective(self, obstacles: Iterable[Obstacle]) -> Objective:
        """The objective among obstacles, which are in the units of curves."""

    @property
    def metric(self) -> Metric:
        """The metric that gradients are taken in."""

    def of_metric(self, metric: Metric) -> Metric:
        """Another metric in the form that this solver works with."""


@dataclass(frozen=True, eq=False)
class Problem:
    """One minimisation: the objective, the metric, the constraints and the units it is solved in."""

    mesh: Mesh
    objective: Objective
    metric: Metric
    constraints: Constraints  # targets of lengths and barycenter, and pins
    units: Units
    geometry: Geometry  # whether the targets are prescribed, or missing them costs energy
    solver: PairSums  # where objective and metric come from, on this mesh and on others
    obstacles: tuple[Obstacle, ...] = ()  # what no motion may touch, in the user's units
    radius: FloatArray | None = None  # of each component as a rope, in the user's units, if it is one

    @classmethod
    def of(
        cls,
        curve: Curve,
        lengths: FloatArray,
        pins: Pins,
        obstacles: tuple[Obstacle, ...],
        solver: PairSums,
        geometry: Geometry,
        barycenters: Barycenters | None = None,
        symmetry: Symmetry = NO_SYMMETRY,
        radius: FloatArray | None = None,
    ) -> "Problem":
        """The problem from a curve on, in the user's units; a CurveError if curve or obstacles are too large for it."""
        units, solver = Units.of(curve), solver.on(curve)
        if len(symmetry):  # about whose centre Σ ℓ_I m_I is symmetric, whatever the lengths are on the way
            units = replace(units, offset=symmetry.centre)
        own = curve.with_vertices(units.from_user(curve.vertices))
        constraints = replace(Constraints.of(own, pins, barycenters), lengths=lengths / units.scale, symmetry=symmetry)
        objective = solver.objective(map(units.obstacle_from_user, obstacles))
        problem = cls(curve.mesh, objective, solver.metric, constraints, units, geometry, solver, obstacles)
        return problem if radius is None else problem.as_rope(radius)

    def on(self, curve: Curve, lengths: FloatArray | None = None, symmetry: Symmetry | None = None) -> "Point":
        """The point of a curve on another mesh, in the same problem there; all in the user's units.

        Pins, parts, the growth so far and, unless there is a new one, the symmetry stay; targets are what the curve
        has, but for lengths that are given, shape (edges,). A CurveError if the curve has too many vertices for the
        solver.
        """
        symmetry = self.constraints.symmetry.on(curve) if symmetry is None else symmetry
        pins, held = self.constraints.pins.on(curve), self.constraints
        lengths = curve.edge_lengths if lengths is None else lengths
        given = pins, self.obstacles, self.solver, self.geometry, held.barycenters, symmetry
        problem = Problem.of(curve, lengths, *given, radius=self.radius)
        constraints = replace(problem.constraints, grown=held.grown)
        # a rope that has let go stays so
        objective = problem.objective if self.objective.rope else problem.objective.having(Rope, None)
        return replace(problem, objective=objective, constraints=constraints).at_curve(curve)

    def as_rope(self, radius: FloatArray | None) -> "Problem":
        """The same for a rope of other radii, shape (components,) in the user's units, or for no rope."""
        rope = None if radius is None else Rope(radius / self.units.scale)
        return replace(self, radius=radius, objective=self.objective.having(Rope, rope))

    def inner_product(self, curve: Curve) -> InnerProduct:
        """The metric, and the stiffness of terms it misses: without, steps near obstacles would be very short."""
        check_time()
        inner, stiffness = self.metric.at(curve), self.objective.stiffness(curve)
        if not isinstance(inner, InnerProduct):
            what = f"metric {self.metric.name!r} gives an object of type {type(inner).__name__}"
            raise OptionError(f"{what} at a curve; give an inner product, such as DenseInnerProduct(matrix)")
        return inner if stiffness is None else inner.plus(SparseInnerProduct(stiffness))

    def at(self, vertices: FloatArray) -> "Point":
        """The point with these vertices, in the program's units; pinned ones are put back to their last digits.

        Those that are to be symmetric are made so; the centre is the origin.
        """
        vertices = self.constraints.symmetry.mean(vertices)
        pins, placed = self.constraints.pins, self.units.to_user(vertices)
        if not len(pins):
            return Point(self, vertices, placed)
        own = self.units.from_user(pins.positions)
        return Point(self, pins.put_back(vertices, own), pins.put_back(placed, pins.positions))

    def at_curve(self, curve: Curve) -> "Point":
        """The point of a curve in the user's units, whose coordinates are kept to the last digit."""
        return Point(self, self.units.from_user(curve.vertices), curve.vertices)

    def clearance(self, curve: Curve) -> FloatArray:
        """How far obstacles are from each edge of a curve, both in the user's units; shape (edges,)."""
        own = curve.with_vertices(self.units.from_user(curve.vertices))
        return self.units.scale * self.objective.clearance(own)

    @property
    def unconfined(self) -> bool:
        """Whether every shape of the curves is allowed: they are closed, and no pins hold them, nor do obstacles."""
        return self.mesh.all_closed and not len(self.constraints.pins) and not self.obstacles

    @property
    def certifiable(self) -> bool:
        """Whether contact is tested: in R² and R³; in more dimensions nothing is knotted."""
        return len(self.units.offset) <= 3

    def free_motion(self, start: FloatArray, end: FloatArray) -> FreeMotion:
        """How far a straight motion in the user's units, both (n, m), is proved free of contact, and that of a rope."""
        check_time()
        if not self.certifiable:
            return FreeMotion(1.0, None, proved=False)
        return rope_motion(self.mesh, start, end, self.radius, self.obstacles)


@dataclass(eq=False, repr=False)
class Point:
    """A polygon with the values that methods ask for, each computed at most once."""

    problem: Problem
    vertices: FloatArray  # in the program's units; shape (n, m)
    placed: FloatArray  # in the user's, rounded: the doubles that proofs are about and that are written
    metric_age: int = 0  # how many steps ago the metric was that of the curve

    def within(self, problem: Problem) -> "Point":
        """The same polygon in another problem on the same mesh."""
        if problem is self.problem:
            return self
        point, own = Point(problem, self.vertices, self.placed), self.problem
        point.curve = self.curve
        if problem.metric is not own.metric:
            return point
        if (problem.constraints, problem.geometry) == (own.constraints, own.geometry) and "tangent_space" in vars(self):
            point.tangent_space = self.tangent_space
        return point.with_metric_of(self, 0)

    def changing(self, **changes: Any) -> "Point":
        """The same polygon in its problem with some fields replaced, but for the mesh."""
        return self.within(replace(self.problem, **changes))

    def pulled(self, pull: Pull | None) -> "Point":
        """The same polygon with another pull of a hand, or none; the other terms are not computed again."""
        before = self.problem.objective.pull
        point = self.changing(objective=self.problem.objective.having(Pull, pull))
        if before is None or pull is None or pull.weights is not before.weights:
            return Point(point.problem, point.vertices, point.placed)  # in another metric
        energy, derivative = self._energy_and_derivative
        (old, by_old), (new, by_new) = (each.value_and_derivative(self.curve) for each in (before, pull))
        point._energy_and_derivative = energy + (new - old), derivative + (by_new - by_old)
        return point

    @property
    def anchored(self) -> "Point":
        """The same polygon, where approximations of the objective are those for itself: for a search from here."""
        objective = self.problem.objective.frozen_at(self.curve)
        same = objective is self.problem.objective
        return self if same else self.changing(objective=objective)

    def with_metric_of(self, other: "Point", steps: int = 1) -> "Point":
        """The same point in the metric of another one, some steps earlier, if that is built and its own is not."""
        if "inner_product" in vars(self) or "inner_product" not in vars(other):
            return self
        point = copy(self)
        point.inner_product, point.metric_age = other.inner_product, other.metric_age + steps
        return point

    def with_own_metric(self) -> "Point":
        """The same point in the metric of its own curve."""
        return self if self.metric_age == 0 else Point(self.problem, self.vertices, self.placed)

    @cached_property
    def curve(self) -> Curve:
        return Curve(self.vertices, self.problem.mesh)

    @property
    def nondegenerate(self) -> bool:
        return bool(np.isfinite(self.vertices).all() and self.curve.edge_lengths.min() > 0.0)

    def retract(self, vertices: FloatArray, level: FloatArray, space: TangentSpace | None = None) -> "Point | None":
        """Find Q near ``vertices`` with Φ(Q) = ``level`` by Q ← Q − C(P)^† (Φ(Q) − level), P this point: (42).

        The pseudo-inverse is that of ``space``, by default in this point's metric.  Once corrections are small the
        derivative is that at Q and the pseudo-inverse one that is cheap, by which the residual vanishes quadratically.
        There is always one: many short steps, each within the tolerance, would drift away together, and energy that
        lengths so gain or lose be taken for the step's.  None if the residual does not contract: the step was too long.
        """
        problem, geometry, last = self.problem, self.problem.geometry, np.inf
        for corrections in range(geometry.max_iterations):
            point = problem.at(vertices)
            if not point.nondegenerate:
                return None
            if not geometry.prescribes:  # every polygon is allowed
                return point
            residual = point.residual - level
            error = problem.constraints.error(problem.mesh, residual)
            if error <= geometry.tolerance and corrections:
                return point
            if not error <= geometry.contraction * last:
                return None
            last, space = error, self.tangent_space if space is None else space
            correction = space.restoration(problem.constraints, point.curve, residual)
            change = np.linalg.norm(problem.mesh.changes(correction), axis=1)  # how it turns or stretches edges
            if np.max(change / point.curve.edge_lengths) > geometry.small:
                correction = -space.pseudo_inverse(residual)
            vertices = vertices + correction
        return None

    def transport(self, u: FloatArray) -> FloatArray:
        """A vector of another tangent space moved to that of this point; shape (n, m)."""
        return self.tangent_space.project(u) if self.problem.geometry.prescribes else u

    @cached_property
    def _energy_and_derivative(self) -> tuple[float, FloatArray]:
        check_time()
        value, derivative = self.problem.geometry.value_and_derivative(
            self.problem.objective, self.problem.constraints, self.curve
        )
        return value, self.problem.constraints.symmetry.mean(derivative)

    @property
    def energy(self) -> float:
        return self._energy_and_derivative[0]

    @property
    def derivative(self) -> FloatArray:
        return self._energy_and_derivative[1]

    @cached_property
    def residual(self) -> FloatArray:
        """How far r lengths and p barycenters are from their targets, shape (r + p·m,); 0 where none is prescribed."""
        return self.problem.geometry.residual(self.problem.constraints, self.curve)

    @property
    def infeasibility(self) -> float:
        """The same as one number: relative error of a length, or displacement of a barycenter."""
        return self.problem.constraints.error(self.problem.mesh, self.residual)

    @cached_property
    def inner_product(self) -> InnerProduct:
        """The metric, on functions along the curve: that of this curve, or of one some steps ago."""
        return self.problem.inner_product(self.curve)

    @cached_property
    def tangent_space(self) -> TangentSpace:
        """Where directions lie, with the metric."""
        problem = self.problem
        return problem.geometry.tangent_space(problem.constraints, self.curve, problem.metric, self.inner_product)

    @cached_property
    def _gradient_and_multipliers(self) -> tuple[FloatArray, FloatArray]:
        return self.tangent_space.gradient(self.derivative)

    @property
    def gradient(self) -> FloatArray:
        """Projected gradient u (penalised problems: gradient), shape (n, m)."""
        return self._gradient_and_multipliers[0]

    @property
    def multipliers(self) -> FloatArray:
        """Lagrange multipliers λ of r lengths and p barycenters, shape (r + p·m,); 0 where none is prescribed."""
        return self._gradient_and_multipliers[1]

    @cached_property
    def gradient_norm(self) -> float:
        """Metric norm of the projected gradient: ⟨u, u⟩ = (DE − Cᵀ λ)·u = DE·u, of which rounding leaves less."""
        return float(np.sqrt(max(0.0, np.sum(self.gradient * self.lagrangian_derivative(self.multipliers)))))

    def lagrangian_derivative(self, multipliers: FloatArray) -> FloatArray:
        """DE − DΦᵀ λ for given multipliers, shape (n, m): the covector whose zeros are critical points."""
        return self.derivative - self.tangent_space.constraints.apply_transpose(multipliers)
