"""One relaxation in progress: its state, its events, and the interventions that may answer them between steps."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..curve import Curve, Mesh
from ..curve.refine import Resolution
from ..descent import METHODS, Method, NoStep, Point, Problem, State, Step
from ..descent.searches import LineSearch
from ..energies.components import energy_scale
from ..energies.pull import Pull, share_of
from ..hierarchy import SampledErrors
from ..messages import Message
from ..passes import Stage
from ..types import FloatArray
from .options import RelaxOptions
from .outcome import Outcome, Rises, Status, converged, degenerate
from .trajectory import Iterate, StrandMoves

HELD_METRIC_STEPS = 10  # while a hand pulls, when prompt answers matter more than few steps
LENGTHS_REACHED = 1e-6  # max |log ℓ/ℓ⁰| that a converged curve may have


class Start:
    """Nothing has happened yet on this mesh."""


Event = Start | Step | NoStep | Outcome


@dataclass(frozen=True, eq=False)
class Change:
    """Steps, if any, and then another view of the same curve."""

    steps: tuple[Step, ...] = ()  # motions that come first
    point: Point | None = None  # the curve reached, in another problem: with other constraints, or on another mesh
    method: Method | None = None  # the method that takes over
    resolution: Resolution | None = None  # new bounds of edge lengths


class Run:
    """A relaxation in progress from a refined curve: the point reached, and what its method remembers.

    ``iterate`` is the point as users see it, ``method`` takes the next step, ``resolution`` bounds edge lengths where
    the mesh may change, ``sampled_errors`` are the hierarchical solver's errors when last checked, and ``rises`` the
    increases of the energy.  The options give the limit of iterations unless another one is passed.
    """

    def __init__(
        self, problem: Problem, start: Curve, options: RelaxOptions, max_iterations: int | None = None
    ) -> None:
        self.options = options
        self.max_iterations = options.max_iterations if max_iterations is None else max_iterations
        self.resolution = Resolution(options.vertices, clearance=problem.clearance)
        self.method = METHODS[options.method]
        self.sampled_errors: SampledErrors | None = None
        self.rises = Rises()
        self.point = problem.at_curve(start).anchored
        self._memory = State()
        self.charged = 0  # iterations of trials, less iterates of strand moves
        self.strand_moves: StrandMoves | None = None
        self._certified = problem.certifiable  # an embedded start, and so far no motion
        self.iterate = self._described(0)

    @property
    def problem(self) -> Problem:
        """The problem on the present mesh, in the metric of the requested method."""
        return self.point.problem

    @property
    def frozen(self) -> bool:
        return len(self.iterate.pins) == self.problem.mesh.size

    @property
    def iterations_left(self) -> int:
        return self.max_iterations - self.iterations

    @property
    def iterations(self) -> int:
        """Iterations so far, including those of rejected trials."""
        return self.iterate.index + self.charged

    def step(self) -> Step | NoStep:
        """The present method's next step, ending at a point of the present problem."""
        point, rule = self.point, self.method.rule
        if self.problem.objective.pull is not None and isinstance(rule, LineSearch) and rule.metric_steps > 1:
            rule = replace(rule, metric_steps=HELD_METRIC_STEPS)
        if self.method.name != self.options.method:
            point = point.changing(metric=self.problem.solver.of_metric(self.method.metric))
        try:
            step, self._memory = rule.step(point, self._memory)
            if isinstance(step, Step):
                step = step.within(self.problem)
                step.point.gradient_norm  # noqa: B018 (computed here, where its failure can be reported)
        except np.linalg.LinAlgError as error:
            return NoStep(degenerate(error))
        return step

    def accept(self, step: Step) -> Iterate:
        before = self.iterate
        self._go(step)
        if self.problem.geometry.prescribes and self.problem.objective.pull is None:
            self.rises.step(before, self.iterate)
        return self.iterate

    def pull(self, pull: Pull | None) -> None:
        """Go on from the same curve with another pull of a hand, or none."""
        held = self.problem.objective.pull is not None
        self.start_from(self.point.pulled(pull))
        if held != (pull is not None):
            self._memory = State()

    def go_back(self, point: Point, iterate: Iterate) -> None:
        """Go on from an earlier point, and the iterate there, as if nothing after it had happened."""
        self.iterate, self._certified = iterate, iterate.certified
        self.start_from(point)

    def renew(self) -> None:
        """Restart the count of iterations."""
        self.charged = -self.iterate.index

    def start_from(self, point: Point) -> None:
        """Go on from another view of the same curve, of which the method remembers nothing."""
        self.point, self._memory = point.anchored, State(None, self._memory.last_step)

    def _pulled(self, point: Point) -> Point:
        """A point on another mesh, pulled like this one, if it is: at the same place, to the same target."""
        pull, old, new = self.problem.objective.pull, self.problem.units, point.problem.units
        if pull is None:
            return point
        place, target = (new.from_user(old.to_user(x)) for x in (self.point.vertices[pull.vertex], pull.target))
        component = int(self.problem.mesh.component[pull.vertex])
        pull = Pull.at(point.curve, component, share_of(point.curve, component, place), pull.strength)
        return point.changing(objective=point.problem.objective.pulled(replace(pull, target=target)))

    def hop(self, end: Point, path: tuple[FloatArray, ...], certified: bool) -> Iterate:
        """Go in one iterate to a point on the same mesh, along a path found elsewhere."""
        self.point, self.method, self._memory = end, METHODS[self.options.method], State()
        self._certified &= certified
        self.iterate = self._described(self.iterate.index + 1, path=path)
        return self.iterate

    def moved(self, stages: Sequence[Stage], end: Point, strand_moves: StrandMoves) -> Iterator[Iterate]:
        """Go along the proved stages of strand moves to their end, a point of the problem there; nothing is charged."""
        meshes = [self.iterate.curve.mesh, *(stage.start.mesh for stage in stages)]
        frames: list[tuple[Curve, tuple[FloatArray, ...]]] = []
        for before, stage in zip(meshes, stages, strict=False):
            frames += [(stage.start, ())] * (stage.start.mesh is not before)
            frames += [(stage.end, stage.path)] * bool(stage.path)
        self.point, pins = end, end.problem.constraints.pins
        there = self._described(self.iterate.index)
        for made, (curve, path) in enumerate(frames, strand_moves.iterates + 1):
            self.charged -= 1
            self.strand_moves = strand_moves._replace(iterates=made)  # so far, for the run may be interrupted here
            held = tuple(pins.on(curve).vertices.tolist())
            now = replace(there, curve=curve, path=path, pins=held, strand_moves=self.strand_moves)
            self.iterate = replace(now, index=self.iterate.index + 1)
            yield self.iterate

    def restarted(self, point: Point) -> Iterate:
        """Go on after strand moves from a point of the problem on another mesh, as at the start; the curve stays."""
        self.point, self.method, self._memory = point.anchored, METHODS[self.options.method], State()
        self.charged -= 1
        if self.strand_moves:
            self.strand_moves = self.strand_moves._replace(iterates=self.strand_moves.iterates + 1, done=True)
        self.iterate = self._described(self.iterate.index + 1)
        return self.iterate

    def allows(self, change: Change) -> bool:
        """Whether the budget suffices for a change: each step is an iteration, and so is another mesh."""
        return len(change.steps) + self._remeshes(change) <= self.iterations_left

    def change(self, change: Change) -> Iterator[Iterate]:
        """Make a change; yield the iterates it leads to, one for each step and one for a new mesh."""
        for step in change.steps:
            before = self.iterate
            self._go(step)
            yield self.iterate
            if not step.size:  # others have been found by a search, and lower the energy
                self.rises.change(before, self.iterate)
        self.resolution = change.resolution or self.resolution
        if change.method is not None:
            self.method, self._memory = change.method, State()
        if change.point is None:
            return
        before, remeshed = self.iterate, self._remeshes(change)
        self.start_from(self._pulled(change.point) if remeshed else change.point)
        self.iterate = self._described(self.iterate.index + remeshed)
        if remeshed:
            self.rises.change(before, self.iterate)
            yield self.iterate

    def termination(self) -> Outcome | None:
        """How the run ends here; None if it continues."""
        bound = gradient_bound(self.options, self.problem.mesh, self.point.energy)
        if self.point.gradient_norm <= bound and self.feasible:
            norm = self.point.with_own_metric().gradient_norm
            if norm <= bound:
                outcome = converged(norm, bound)
                frozen = "nothing can move: the curve is pinned, or straight between pins"
                return outcome.adding(frozen) if self.frozen else outcome
        return self.at_limit() if self.iterations_left <= 0 else None

    def at_limit(self) -> Outcome:
        """How the run ends at the iteration limit."""
        reached = Message("stopped at the iteration limit ({count})", count=self.iterations)
        outcome = Outcome(Status.ITERATION_LIMIT, (reached,))
        if self.feasible:
            return outcome
        uneven = "lengths are still up to {percent:.2g} % off target"
        return outcome.adding(uneven, percent=100 * self.iterate.edge_length_error)

    @property
    def feasible(self) -> bool:
        """Whether lengths are those prescribed, if any are."""
        return not self.problem.geometry.prescribes or self.iterate.edge_length_error <= LENGTHS_REACHED

    def _go(self, step: Step) -> None:
        self.point = step.point.anchored
        self._certified &= step.certified
        path = tuple(leg.end.placed for leg in step.legs)
        self.iterate = self._described(self.iterate.index + 1, step.size, path)

    def _remeshes(self, change: Change) -> bool:
        """Whether a change is to another mesh, perhaps with as many vertices."""
        return change.point is not None and change.point.problem.mesh is not self.problem.mesh

    def _described(self, index: int, step_size: float = 0.0, path: tuple[FloatArray, ...] = ()) -> Iterate:
        point, constraints, pull = self.point, self.problem.constraints, self.problem.objective.pull
        return Iterate(
            index=index,
            curve=Curve(point.placed, point.problem.mesh),
            energy=point.energy_as_placed - (0.0 if pull is None else pull.value(point.curve)),
            gradient_norm=point.gradient_norm,
            step_size=step_size,
            path=path,
            certified=self._certified,
            edge_length_error=constraints.length_error(point.curve),
            grown=constraints.grown,
            method=self.method.name,
            pins=tuple(constraints.pins.vertices.tolist()),
            strand_moves=self.strand_moves,
            symmetry=constraints.symmetry.name,
        )


def gradient_bound(options: RelaxOptions, mesh: Mesh, energy: float) -> float:
    """Norm of the projected gradient at which a curve of this energy is at rest."""
    return options.tolerance * float(np.sqrt(energy_scale(mesh, energy)))


@dataclass(eq=False)
class Intervention:
    """A possible change of a run between steps: made for one run, it is called after every event.

    A subclass overrides the methods for the events that concern it, or ``__call__`` for all at once.  Each returns the
    event as later interventions are to see it, or a change, after which these are not asked, or None, which leaves the
    event as it is.  Settings are fields.
    """

    run: Run

    def __call__(self, event: Event) -> Event | Change:
        answer: Event | Change | None
        match event:
            case Start():
                answer = self.started()
            case Step():
                answer = self.stepped(event)
            case NoStep():
                answer = self.stuck(event)
            case Outcome():
                answer = self.ended(event)
        return event if answer is None else answer

    def started(self) -> Event | Change | None:
        """At the start, and after every change of mesh."""
        return None

    def stepped(self, step: Step) -> Event | Change | None:
        """After a step of the method."""
        return None

    def stuck(self, found: NoStep) -> Event | Change | None:
        """Where the method finds no step."""
        return None

    def ended(self, outcome: Outcome) -> Event | Change | None:
        """Where the run would end."""
        return self.converged(outcome) if outcome.converged else None

    def converged(self, outcome: Outcome) -> Event | Change | None:
        """Where it would end at rest."""
        return None
