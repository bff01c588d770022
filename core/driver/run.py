"""One relaxation in progress: its state, how that changes, and when it stops."""

from collections import deque
from collections.abc import Generator, Iterator
from dataclasses import replace
from typing import ClassVar

import numpy as np

from ..base import FloatArray, Message
from ..curve import Curve, Mesh, Resolution, at_edges
from ..descent import METHODS, LineSearch, NoStep, Point, Problem, SearchState, Step
from ..energies.components import energy_scale
from ..energies.hierarchy import SampledErrors
from ..io.trajectory import Iterate, StrandMoves
from .hand import Hand
from .options import RelaxOptions
from .outcome import Outcome, Rises, Status, converged, degenerate, stalled

Relaxation = Generator[Iterate, None, Outcome]


class Run:
    """A relaxation in progress from a refined curve: the point reached, and what its method remembers.

    ``iterate`` is the point as users see it, ``method`` takes the next step, ``resolution`` bounds edge lengths where
    the mesh may change, ``sampled_errors`` are the hierarchical solver's errors when last checked, and ``rises`` the
    increases of the energy.  The options give the ``limit`` of iterations unless another one is passed.  A ``hand``
    may drag the curve.
    """

    # part of the energy that goes in so many iterations as long as the flow makes headway
    headway: ClassVar[float] = 0.01
    looking_back: ClassVar[int] = 100

    def __init__(self, problem: Problem, start: Curve, options: RelaxOptions, limit: int | None = None) -> None:
        self.options = options.resolved
        self.max_iterations = options.max_iterations if limit is None else limit
        self.hand: Hand | None = None
        self.resolution = Resolution(options.vertices, clearance=problem.clearance)
        self.method = METHODS[options.method]
        self.sampled_errors: SampledErrors | None = None
        self.rises = Rises()
        self.memory = SearchState()
        self.charged = 0  # iterations of trials, less iterates of strand moves
        self.strand_moves: StrandMoves | None = None
        self.energies: deque[float] = deque(maxlen=self.looking_back + 1)  # of the last iterates
        self.point = problem.at_curve(start).anchored
        self.certified = problem.certifiable  # an embedded start, and so far no motion
        self.iterate = self.described(0)

    @property
    def problem(self) -> Problem:
        """The problem on the present mesh, in the metric of the requested method."""
        return self.point.problem

    @property
    def frozen(self) -> bool:
        return len(self.iterate.pins) == self.problem.mesh.size

    @property
    def iterations(self) -> int:
        """Iterations so far, including those of rejected trials."""
        return self.iterate.index + self.charged

    @property
    def iterations_left(self) -> int:
        return self.max_iterations - self.iterations

    @property
    def feasible(self) -> bool:
        """Whether lengths are those prescribed, if any are."""
        # max |log ℓ/ℓ⁰| that a converged curve may have
        return not self.problem.geometry.prescribes or self.iterate.edge_length_error <= 1e-6

    @property
    def makes_headway(self) -> bool:
        """Whether the last hundred iterations have lowered the energy by a hundredth; so do fewer, until shown."""
        energies = self.energies
        return len(energies) <= self.looking_back or energies[-1] < (1.0 - self.headway) * energies[0]

    def described(self, index: int, step_size: float = 0.0, path: tuple[FloatArray, ...] = ()) -> Iterate:
        """The point as an iterate with a number."""
        point, constraints, pull = self.point, self.problem.constraints, self.problem.objective.pull
        # users get rounded coordinates: far from the origin those of another curve, of another energy beyond 1e-8
        rounded = point.problem.units.from_user(point.placed)
        same = np.max(np.abs(rounded - point.vertices)) <= 1e-8
        energy = point.energy if same else point.problem.at(rounded).energy
        return Iterate(
            index=index,
            curve=Curve(point.placed, point.problem.mesh),
            energy=energy - (0.0 if pull is None else pull.value(point.curve)),
            gradient_norm=point.gradient_norm,
            step_size=step_size,
            path=path,
            certified=self.certified,
            edge_length_error=constraints.length_error(point.curve),
            grown=constraints.grown,
            method=self.method.name,
            pins=tuple(constraints.pins.vertices.tolist()),
            strand_moves=self.strand_moves,
            symmetry=constraints.symmetry.name,
            radius=None if self.problem.radius is None else tuple(self.problem.radius.tolist()),
        )

    def step(self) -> Step | NoStep:
        """The present method's next step, ending at a point of the present problem."""
        point, rule = self.point, self.method.rule
        if self.problem.objective.pull is not None and isinstance(rule, LineSearch) and rule.metric_steps > 1:
            # while a hand pulls, prompt answers matter more than few steps
            rule = replace(rule, metric_steps=10)
        if self.method.name != self.options.method:
            point = point.changing(metric=self.problem.solver.of_metric(self.method.metric))
        try:
            step, self.memory = rule.step(point, self.memory)
            if isinstance(step, Step):
                step = step.within(self.problem)
                step.point.gradient_norm  # noqa: B018 (computed here, where its failure can be reported)
        except np.linalg.LinAlgError as error:
            return NoStep(degenerate(error))
        return step

    def go(
        self, point: Point, path: tuple[FloatArray, ...] = (), certified: bool = True, step_size: float = 0.0
    ) -> Iterate:
        """The next iterate: at a point, after straight motions whose ends are given, or none onto another mesh."""
        self.point = point.anchored
        self.certified &= certified
        self.iterate = self.described(self.iterate.index + 1, step_size, path)
        return self.iterate

    def take(self, step: Step) -> Iterate:
        """The next iterate, at the end of a step of whatever kind."""
        return self.go(step.point, tuple(leg.end.placed for leg in step.legs), step.certified, step.size)

    def accept(self, step: Step) -> Iterate:
        """The next iterate, by a step of the method."""
        before = self.iterate
        self.energies.append(self.take(step).energy)
        if self.problem.geometry.prescribes and self.problem.objective.pull is None:
            self.rises.step(before, self.iterate)
        return self.iterate

    def view(self, point: Point) -> None:
        """Go on from another view of the same curve, of which the method remembers nothing unless it does the same."""
        parts = "objective", "constraints", "metric", "geometry"
        same = all(getattr(point.problem, part) is getattr(self.problem, part) for part in parts)
        self.point, self.memory = point.anchored, self.memory if same else SearchState(None, self.memory.last_step)

    def restart(self) -> None:
        """Go on with the requested method, which remembers nothing."""
        self.method, self.memory = METHODS[self.options.method], SearchState()

    def enter(self, point: Point) -> Iterator[Iterate]:
        """Go on at a point of another problem; yield the iterate that it is if it is on another mesh."""
        if point.problem.mesh is self.problem.mesh:  # another one may have as many vertices
            self.view(point)
            self.iterate = self.described(self.iterate.index)
            return
        before, pull = self.iterate, self.problem.objective.pull
        if pull is not None:  # by the hand at the same place, to the same target
            old, new = self.problem.units, point.problem.units
            point = point.pulled(pull.on(self.point.curve, point.curve, lambda x: new.from_user(old.to_user(x))))
        self.memory = SearchState(None, self.memory.last_step)
        self.rises.change(before, self.go(point))
        yield self.iterate

    def stopping(self, event: object = None) -> Outcome | None:
        """How the run ends here, or after an event that no move knows an answer to; None if it goes on.

        These are all rules but two: the time limit acts even in the middle of a step (`within`), and an interrupt or
        the end of memory ends the loop over the iterates (`finish`).
        """
        if isinstance(event, NoStep):
            limits, curve = event.limited_by, self.iterate.curve
            return stalled(event.reason, None if limits is None else at_edges(curve, limits.edges))
        if isinstance(event, Outcome):
            return event
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


def gradient_bound(options: RelaxOptions, mesh: Mesh, energy: float) -> float:
    """Norm of the projected gradient at which a curve of this energy is at rest."""
    return options.tolerance * float(np.sqrt(energy_scale(mesh, energy)))
