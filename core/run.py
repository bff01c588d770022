"""One relaxation under way: steps and changes of mesh, until the judgement ends it."""

from collections.abc import Generator, Iterator
from dataclasses import replace

import numpy as np

from .adaptive import INTERVAL, adapt, graded_problem
from .curve import Curve
from .descent import NoStep, Point, Problem, Step
from .descent.searches import Escape
from .errors import CurveError
from .iterate import Iterate, Status
from .judgement import judged, unresolved
from .options import RelaxOptions
from .parting import separate_parts
from .setup import embedded_refinement, method_named, start_problem
from .stepping import Stepper
from .types import FloatArray

FINER = 1.5  # factor of the number of vertices when a converged curve is not resolved
FINEST = 3.5  # factor of that number at which strands are said to pull tight for ever


class Run:
    """The state of one relaxation; `iterates` advances it.

    Parameters
    ----------
    problem
        What is solved on the start's mesh.
    start
        The refined curve, in the user's units.
    options
        What is asked for.
    """

    def __init__(self, problem: Problem, start: Curve, options: RelaxOptions) -> None:
        self._options = options
        self._vertices = options.vertices
        self._first_count = len(start)
        self._certified = problem.certifiable  # an embedded start, and so far no motion
        self._begin(graded_problem(problem, start, options.vertices) if options.adaptive else problem, start, 0)
        self._stepper = Stepper(method_named(options.method))

    def iterates(self) -> Iterator[Iterate]:
        """Yield the start and every accepted step; the last iterate has a status other than RUNNING."""
        seen = -1
        try:
            for iterate in self._iterates():
                seen = iterate.index
                yield iterate
        except np.linalg.LinAlgError as error:
            message = f"stalled: the curve has become too degenerate: {error}"
            path = () if self._iterate.index == seen else self._iterate.path
            yield replace(self._iterate, status=Status.STALLED, message=message, path=path)

    def _iterates(self) -> Iterator[Iterate]:
        just_refined = False  # around edges that were stuck: once is enough
        while True:
            iterate, way_down = judged(self._point, self._iterate, self._options)
            if iterate.status is Status.CONVERGED and unresolved(iterate.curve):
                finer = self._finer()
                if finer is not None:
                    yield replace(iterate, status=Status.RUNNING, message="")
                    self._begin(*finer, iterate.index + 1)
                    self._stepper.restart()
                    continue
                iterate = self._tight(iterate)
            yield iterate
            if iterate.status is not Status.RUNNING:
                return
            step = self._step(way_down)
            if isinstance(step, Step):
                self._accept(step)
                if self._iterate.index % INTERVAL == 0:
                    self._hold_parts()
                if self._options.adaptive and self._iterate.index % INTERVAL == 0:
                    yield from self._adapt(None)
                just_refined = False
                continue
            if way_down is not None:
                message = f"converged: a saddle with index {iterate.negative_eigenvalues}; no way down was found"
                yield replace(iterate, status=Status.CONVERGED, message=message, path=())
                return
            stuck = self._options.adaptive and step.limited_by is not None and not just_refined
            just_refined = stuck and (yield from self._adapt(step.limited_by))
            if not just_refined:
                message = f"stalled: {step.reason}{self._advice()}"
                yield replace(iterate, status=Status.STALLED, message=message, path=())
                return

    def _step(self, way_down: tuple[FloatArray, float] | None) -> Step | NoStep:
        """The next step, from a saddle along the way down."""
        if way_down is None:
            return self._stepper.step(self._point)
        self._stepper.restart()
        return Escape().step(self._point, *way_down)

    def _begin(self, problem: Problem, curve: Curve, index: int) -> None:
        """Start on a mesh."""
        self._problem = problem
        self._point = problem.at_curve(curve)
        self._iterate = self._described(self._point, index, 0.0, ())

    def _accept(self, step: Step) -> None:
        self._point = step.point
        self._certified &= step.certified
        path = tuple(leg.end.placed for leg in step.legs)
        self._iterate = self._described(step.point, self._iterate.index + 1, step.size, path)

    def _adapt(self, stuck: tuple[int, int] | None) -> Generator[Iterate, None, bool]:
        """Change the mesh where needed; yield the iterates of the old one that nobody has seen yet.

        Returns whether it was changed.
        """
        change = adapt(self._problem, self._iterate.curve, self._vertices, stuck)
        if change is None:
            return False
        if stuck is None:
            yield self._iterate
        self._certified &= change.proof.proved
        moved = self._problem.at_curve(change.moved)
        index = self._iterate.index
        # the last motion on the old mesh, then the same curve on the new one
        self._iterate = self._described(moved, index + 1, 0.0, (moved.placed,))
        yield self._iterate
        self._begin(change.problem, change.curve, index + 2)
        self._stepper.restart()
        return True

    def _hold_parts(self) -> None:
        """Keep parts that are not linked from drifting apart for ever, once they are far from each other."""
        constraints = self._problem.constraints
        if not self._problem.geometry.prescribes:
            return
        parts = separate_parts(self._iterate.curve)
        if max(parts) > max(constraints.parts or (0,)):
            constraints = constraints.of_parts(self._point.curve, parts)
            self._problem = replace(self._problem, constraints=constraints)
            self._point = self._point.within(self._problem)
            self._iterate = replace(self._iterate, gradient_norm=self._point.gradient_norm)
            self._stepper.restart()

    def _finer(self) -> tuple[Problem, Curve] | None:
        """The problem and the same curve with more vertices, if that is wanted and possible."""
        curve = self._iterate.curve
        if not self._options.resolve or len(curve) >= FINEST * self._first_count:
            return None
        vertices = int(np.ceil(FINER * len(curve)))
        try:
            curve = embedded_refinement(curve, vertices)
            problem = start_problem(curve, self._options)
        except CurveError:
            return None  # more than can be solved with, or too far from the origin for more digits
        if self._options.adaptive:
            problem = graded_problem(problem, curve, vertices)
        parts = self._problem.constraints.parts
        if parts is not None:
            own_units = curve.with_vertices(problem.units.from_user(curve.vertices))
            problem = replace(problem, constraints=problem.constraints.of_parts(own_units, parts))
        self._vertices = vertices
        return problem, curve

    def _tight(self, iterate: Iterate) -> Iterate:
        """What to say of a converged curve whose strands are nearer than its mesh resolves."""
        if self._options.resolve:
            message = f"stalled: strands pull tight, nearer than {len(iterate.curve)} vertices resolve"
            return replace(iterate, status=Status.STALLED, message=message)
        note = (
            "; strands are nearer than this mesh resolves, and with more vertices there is less energy to reach: "
            "--resolve (resolve=True) or more vertices go on"
        )
        return replace(iterate, message=iterate.message + note)

    def _advice(self) -> str:
        return "" if self._options.adaptive else "; more vertices or an adaptive mesh may help"

    def _described(self, point: Point, index: int, step_size: float, path: tuple[FloatArray, ...]) -> Iterate:
        return Iterate(
            index=index,
            curve=Curve(point.placed, point.problem.mesh),
            energy=point.energy_as_placed,
            gradient_norm=point.gradient_norm,
            step_size=step_size,
            path=path,
            certified=self._certified,
            edge_length_error=point.problem.constraints.length_error(point.curve),
        )
