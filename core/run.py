"""One relaxation under way: steps, changes of mesh, saddles, and the judgement of every iterate."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from .adaptive import INTERVAL, adapt, graded_problem
from .curve import Curve, refine
from .curve.distances import arc_distance_of_pairs
from .curve.refine import STRAND_RATIO
from .descent import NoStep, Point, Problem, Step
from .descent.escape import escape_step
from .energies import MoebiusEnergy
from .energies.near_pairs import near_pairs
from .iterate import Iterate, Status
from .knots.composite import knotted_ball
from .options import RelaxOptions
from .parting import separate_parts, split
from .setup import method_named, start_problem
from .stability import stability
from .stepping import Stepper
from .types import FloatArray

LENGTHS_REACHED = 1e-6  # max |log ℓ/ℓ⁰| that a converged curve may have
FINER = 1.5  # factor of the number of vertices when a converged curve is not resolved
COMPOSITE_KNOT = 140.0  # less energy than any composite: two trefoils (74.4 each) less a circle make 144.8,
COMPOSITE_LINK = 90.0  # two Hopf links (47.5 each) 91
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
        self._begin(graded_problem(problem, start, options.vertices) if options.adaptive else problem, start, 0)
        self._stepper = Stepper(method_named(options.method))

    def iterates(self) -> Iterator[Iterate]:
        """Yield the start and every accepted step; the last iterate has a status other than RUNNING."""
        just_refined = False  # around edges that were stuck: once is enough
        while True:
            iterate, way_down = _judged(self._point, self._iterate, self._options)
            if iterate.status is Status.CONVERGED:
                iterate = _unless_composite(iterate)
            if iterate.status is Status.CONVERGED and _unresolved(iterate):
                if self._options.resolve and len(iterate.curve) < FINEST * self._first_count:
                    yield replace(iterate, status=Status.RUNNING, message="")
                    self._make_finer()
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
            if not self._options.adaptive or step.limited_by is None or just_refined:
                yield replace(
                    iterate, status=Status.STALLED, message=f"stalled: {step.reason}{self._advice()}", path=()
                )
                return
            yield from self._adapt(step.limited_by)
            just_refined = True

    def _step(self, way_down: tuple[FloatArray, float] | None) -> Step | NoStep:
        """The next step, from a saddle along the way down."""
        if way_down is None:
            return self._stepper.step(self._point)
        self._stepper.restart()
        return escape_step(self._point, *way_down)

    def _begin(self, problem: Problem, curve: Curve, index: int) -> None:
        """Start on a mesh."""
        self._problem, self._start = problem, curve
        self._point = problem.at(problem.units.from_user(curve.vertices))
        self._iterate = self._described(self._point, curve, index, 0.0, ())

    def _accept(self, step: Step) -> None:
        self._point = step.point
        path = tuple(self._problem.units.to_user(vertices) for vertices in step.path)
        curve = self._start.with_vertices(path[-1])
        self._iterate = self._described(step.point, curve, self._iterate.index + 1, step.size, path)

    def _adapt(self, stuck: tuple[int, int] | None) -> Iterator[Iterate]:
        """Change the mesh where needed; yield the iterates of the old one that nobody has seen yet."""
        change = adapt(self._problem, self._iterate.curve, self._vertices, stuck)
        if change is None:
            return
        if stuck is None:
            yield self._iterate
        moved = self._problem.at(self._problem.units.from_user(change.moved))
        curve = self._start.with_vertices(change.moved)
        index = self._iterate.index
        # the last motion on the old mesh, then the same curve on the new one
        yield self._described(moved, curve, index + 1, 0.0, (change.moved,))
        self._begin(change.problem, change.curve, index + 2)
        self._stepper.forget()

    def _hold_parts(self) -> None:
        """Keep parts that are not linked from drifting apart for ever, once they are far from each other."""
        constraints = self._problem.constraints
        if self._problem.penalty is not None:
            return
        parts = separate_parts(self._iterate.curve)
        if max(parts) > max(constraints.parts or (0,)):
            constraints = constraints.of_parts(self._point.curve, parts)
            self._problem = replace(self._problem, constraints=constraints)
            self._point = self._problem.at(self._point.vertices)
            self._iterate = replace(self._iterate, gradient_norm=self._point.gradient_norm)
            self._stepper.forget()

    def _make_finer(self) -> None:
        """Go on with more vertices on the same curve."""
        self._vertices = int(np.ceil(FINER * len(self._iterate.curve)))
        curve = refine(self._iterate.curve, self._vertices)
        problem = start_problem(curve, self._options)
        if self._options.adaptive:
            problem = graded_problem(problem, curve, self._vertices)
        self._begin(problem, curve, self._iterate.index + 1)
        self._stepper.restart()

    def _tight(self, iterate: Iterate) -> Iterate:
        """What to say of a converged curve whose strands are nearer than its mesh resolves."""
        if self._options.resolve:
            message = f"stalled: strands pull tight, nearer than {len(iterate.curve)} vertices resolve"
            return replace(iterate, status=Status.STALLED, message=message)
        note = "; strands are nearer than this mesh resolves, and with more vertices there is less energy to reach"
        return replace(iterate, message=iterate.message + note)

    def _advice(self) -> str:
        return "" if self._options.adaptive else "; more vertices or an adaptive mesh may help"

    def _described(
        self, point: Point, curve: Curve, index: int, step_size: float, path: tuple[FloatArray, ...]
    ) -> Iterate:
        return Iterate(
            index=index,
            curve=curve,
            energy=point.energy,
            gradient_norm=point.gradient_norm,
            step_size=step_size,
            path=path,
            certified=point.problem.certifiable,
            edge_length_error=point.problem.constraints.length_error(point.curve),
        )


def _unless_composite(iterate: Iterate) -> Iterate:
    """The converged iterate; stalled if its curve is composite, for then only the mesh keeps it from going on."""
    components = len(iterate.curve.mesh.component_sizes)
    if MoebiusEnergy().value(iterate.curve) < (COMPOSITE_KNOT if components == 1 else COMPOSITE_LINK):
        return iterate
    ball = knotted_ball(iterate.curve)
    if ball is None:
        return iterate
    place = ", ".join(f"{x:.3g}" for x in ball.center)
    message = (
        "stalled: strands pull tight, and would do so for ever: the curve is composite, knotted both inside and "
        f"outside the ball of radius {ball.radius:.3g} around ({place}), and has no shape of least energy"
    )
    return replace(iterate, status=Status.STALLED, message=message)


def _unresolved(iterate: Iterate) -> bool:
    """Whether strands, not merely edges of very different lengths, are so near that the barrier still acts."""
    curve = iterate.curve
    i, j = near_pairs(curve)
    distance = np.linalg.norm(curve.midpoints[i] - curve.midpoints[j], axis=1)
    return bool(np.any(arc_distance_of_pairs(curve, i, j) > STRAND_RATIO * distance))


def _judged(point: Point, iterate: Iterate, options: RelaxOptions) -> tuple[Iterate, tuple[FloatArray, float] | None]:
    """The iterate with its status, and from a saddle the way down: a direction and its negative curvature."""
    bound = options.tolerance * np.sqrt(abs(point.energy))
    feasible = point.problem.penalty is not None or iterate.edge_length_error <= LENGTHS_REACHED
    way_down = None
    if iterate.gradient_norm <= bound and feasible:
        message = f"converged: projected gradient {iterate.gradient_norm:.3g} ≤ {bound:.3g}"
        parts = point.problem.constraints.parts
        if parts is not None:
            alone = sum(MoebiusEnergy().value(part) for part in split(iterate.curve, parts))
            message += (
                "; parts that are not linked, which would drift apart for ever, are held in their places; the sum of "
                f"their own energies is {alone:.6g}"
            )
        iterate = replace(iterate, status=Status.CONVERGED, message=message)
        if options.stability or options.escape_saddles:
            found = stability(point)
            kind = f"; a saddle with index {found.index}" if found.index else "; a minimum"
            iterate = replace(iterate, negative_eigenvalues=found.index, message=message + kind)
            if options.escape_saddles and found.index:
                iterate = replace(iterate, status=Status.RUNNING, message="")
                way_down = found.directions[0], float(found.eigenvalues[0])
    if iterate.status is not Status.CONVERGED and iterate.index >= options.max_iterations:
        message = f"stopped after {iterate.index} iterations, as asked for"
        iterate = replace(iterate, status=Status.ITERATION_LIMIT, message=message)
    return iterate, way_down
