"""Where one relaxation stands."""

from dataclasses import replace

import numpy as np

from ..curve import Curve
from ..descent import METHODS, NoStep, Problem, State, Step
from ..hierarchy import SampledErrors
from ..types import FloatArray
from .events import Change
from .iterate import Iterate
from .options import RelaxOptions
from .outcome import DEGENERATE
from .solver import Solver

RISE = 1e-9  # relative increase of the energy in one step that is told of; less is rounding


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
    vertices
        Number of vertices where no strands are near, None for the default.
    rises
        Increases of the energy, which are allowed while edge lengths are being evened out.
    sampled_errors
        Of the hierarchical solver, when they were last looked at.
    """

    def __init__(self, problem: Problem, start: Curve, options: RelaxOptions) -> None:
        self.options = options
        self.vertices = options.vertices
        self.method = METHODS[options.method]
        self.rises: list[float] = []
        self.sampled_errors: SampledErrors | None = None
        self.point = problem.at_curve(start).anchored
        self._memory = State()
        self._certified = problem.certifiable  # an embedded start, and so far no motion
        self.iterate = self._described(0)

    @property
    def problem(self) -> Problem:
        """What is solved on the present mesh, in the metric of the method that was asked for."""
        return self.point.problem

    @property
    def at_limit(self) -> bool:
        """Whether there are to be no more iterations."""
        return self.iterate.index >= self.options.max_iterations

    def step(self) -> Step | NoStep:
        """The present method's next step, ending at a point of the present problem."""
        point = self.point
        if self.method.name != self.options.method:
            metric = Solver.of_problem(self.options, self.problem).of_metric(self.method.metric)
            point = point.within(replace(self.problem, metric=metric))
        try:
            step, self._memory = self.method.rule.step(point, self._memory)
            if isinstance(step, Step):
                step = step.within(self.problem)
                step.point.gradient_norm  # noqa: B018 (computed here, where its failure can be told)
        except np.linalg.LinAlgError as error:
            return NoStep(DEGENERATE.format(error=error))
        return step

    def accept(self, step: Step) -> Iterate:
        """Go to the end of a step."""
        before = self.iterate
        self.point = step.point.anchored
        self._certified &= step.certified
        self.iterate = now = self._described(before.index + 1, step.size, tuple(leg.end.placed for leg in step.legs))
        evening_out = self.problem.geometry.prescribes and now.edge_length_error < before.edge_length_error
        if evening_out and now.energy > (1.0 + RISE) * before.energy:
            self.rises.append(now.energy - before.energy)
        return now

    def change(self, change: Change) -> Iterate | None:
        """Go on from a point of another problem, or by another method; a new mesh makes a new iterate."""
        self.vertices = change.vertices or self.vertices
        if change.method is not None:
            self.method, self._memory = change.method, State()
        if change.point is None:
            return None
        remeshed = change.point.placed is not self.point.placed  # perhaps with as many vertices
        self.point = change.point.anchored
        self._memory = State(None, self._memory.last_step)
        self.iterate = self._described(self.iterate.index + remeshed)
        return self.iterate if remeshed else None

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
            method=self.method.name,
        )
