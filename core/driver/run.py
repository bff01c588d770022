"""Where one relaxation stands."""

from dataclasses import replace

import numpy as np

from ..curve import Curve
from ..curve.refine import Resolution
from ..descent import METHODS, NoStep, Point, Problem, State, Step
from ..hierarchy import SampledErrors
from ..types import FloatArray
from .events import Change
from .iterate import Iterate
from .options import RelaxOptions
from .outcome import degenerate


class Run:
    """A relaxation under way: the point it has reached, and what its method remembers.

    Parameters
    ----------
    problem
        What is solved on the start's mesh.
    start
        The refined curve, in the user's units.
    options
        What is asked for.
    max_iterations
        How many iterations there may be, if not as many as the options allow.

    Attributes
    ----------
    options
        The same.
    point
        Where it stands.
    iterate
        The same as users see it.
    method
        Which method takes the next step.
    resolution
        How long edges may be, where the mesh can be changed.
    sampled_errors
        Of the hierarchical solver, when they were last looked at.
    """

    def __init__(
        self, problem: Problem, start: Curve, options: RelaxOptions, max_iterations: int | None = None
    ) -> None:
        self.options = options
        self.max_iterations = options.max_iterations if max_iterations is None else max_iterations
        self.resolution = Resolution(options.vertices, clearance=problem.clearance)
        self.method = METHODS[options.method]
        self.sampled_errors: SampledErrors | None = None
        self.point = problem.at_curve(start).anchored
        self._memory = State()
        self._tried = 0
        self._certified = problem.certifiable  # an embedded start, and so far no motion
        self.iterate = self._described(0)

    @property
    def problem(self) -> Problem:
        """What is solved on the present mesh, in the metric of the method that was asked for."""
        return self.point.problem

    @property
    def frozen(self) -> bool:
        """Whether all vertices are held."""
        return len(self.iterate.pins) == self.problem.mesh.size

    @property
    def iterations_left(self) -> int:
        """How many more iterations there may be."""
        return self.max_iterations - self.iterations

    @property
    def iterations(self) -> int:
        """How many there were, those of trials included of which nothing is left."""
        return self.iterate.index + self._tried

    def step(self) -> Step | NoStep:
        """The present method's next step, ending at a point of the present problem."""
        point = self.point
        if self.method.name != self.options.method:
            point = point.within(replace(self.problem, metric=self.problem.solver.of_metric(self.method.metric)))
        try:
            step, self._memory = self.method.rule.step(point, self._memory)
            if isinstance(step, Step):
                step = step.within(self.problem)
                step.point.gradient_norm  # noqa: B018 (computed here, where its failure can be told)
        except np.linalg.LinAlgError as error:
            return NoStep(degenerate(error))
        return step

    def accept(self, step: Step) -> Iterate:
        """Go to the end of a step."""
        self.point = step.point.anchored
        self._certified &= step.certified
        path = tuple(leg.end.placed for leg in step.legs)
        self.iterate = self._described(self.iterate.index + 1, step.size, path)
        return self.iterate

    def count_tried(self, iterations: int) -> None:
        """Take those of a trial off the iterations that are left."""
        self._tried += iterations

    def hop(self, end: Point, path: tuple[FloatArray, ...], certified: bool) -> Iterate:
        """Go in one iterate to a point on the same mesh, by a way that was found elsewhere."""
        self.point, self.method, self._memory = end, METHODS[self.options.method], State()
        self._certified &= certified
        self.iterate = self._described(self.iterate.index + 1, path=path)
        return self.iterate

    def allows(self, change: Change) -> bool:
        """Whether a change is within the limit: a step is an iteration, and so is another mesh."""
        return len(change.steps) + self._remeshes(change) <= self.iterations_left

    def change(self, change: Change) -> Iterate | None:
        """Go on from a point of another problem, or by another method; a new mesh makes a new iterate."""
        self.resolution = change.resolution or self.resolution
        if change.method is not None:
            self.method, self._memory = change.method, State()
        if change.point is None:
            return None
        remeshed = self._remeshes(change)
        self.point = change.point.anchored
        self._memory = State(None, self._memory.last_step)
        self.iterate = self._described(self.iterate.index + remeshed)
        return self.iterate if remeshed else None

    def _remeshes(self, change: Change) -> bool:
        """Whether it is to another mesh, perhaps with as many vertices."""
        return change.point is not None and change.point.problem.mesh is not self.problem.mesh

    def _described(self, index: int, step_size: float = 0.0, path: tuple[FloatArray, ...] = ()) -> Iterate:
        point = self.point
        return Iterate(
            index=index,
            curve=Curve(point.placed, point.problem.mesh),
            energy=point.energy_as_placed,
            gradient_norm=point.gradient_norm,
            step_size=step_size,
            path=path,
            certified=self._certified,
            edge_length_error=point.problem.constraints.length_error(point.curve),
            grown=point.problem.constraints.grown,
            method=self.method.name,
            pins=tuple(point.problem.constraints.pins.vertices.tolist()),
        )
