"""What may act on a run between its steps: events, the changes that moves answer with, and the loop over both."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from ..curve import Resolution
from ..descent import Method, NoStep, Point, SearchState, Step
from ..io.trajectory import Iterate
from .outcome import Outcome, degenerate, stalled
from .run import Relaxation, Run


class Start:
    """Nothing has happened yet on this mesh."""


Event = Start | Step | NoStep | Outcome


@dataclass(frozen=True, eq=False)
class Change:
    """What a move proposes: proved steps, if any, and then another view of the curve they lead to."""

    steps: tuple[Step, ...] = ()  # motions that come first; that they end on the constraints is up to the move
    point: Point | None = None  # the curve reached, in another problem: with other constraints, or on another mesh
    method: Method | None = None  # the method that takes over
    resolution: Resolution | None = None  # new bounds of edge lengths
    iterates: Iterable[Iterate] = ()  # motions that change the run themselves as they go on
    anew: bool = False  # whether the run goes on from there as from a start


@dataclass(eq=False)
class Move:
    """What may act on a run between steps: made for one run, it is called after every event.

    A subclass overrides the methods for the events that concern it, or ``__call__`` for all at once.  Each returns the
    event as later moves are to see it, or a change, after which these are not asked, or None, which leaves the
    event as it is.  Settings are fields.  Where the run goes on as from a start moves are made again, unless they last.
    """

    run: Run
    lasts: ClassVar[bool] = False

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

    def summarised(self, outcome: Outcome) -> Outcome:
        """The outcome of the whole run with clauses about what the move did."""
        return outcome


def iterates(run: Run, moves: Sequence[Callable[[Run], Move]]) -> Relaxation:
    """Yield the start and every accepted step, motion or change of mesh, each once; return how it ended.

    After every event the moves are asked in turn, until one of them answers with a change.  Where none does, the run
    ends if a rule says so, or the method takes its next step.
    """
    made = [make(run) for make in moves]
    yield run.iterate
    event: Event = Start()
    ending: Outcome | None = None
    while ending is None:
        mesh, answer = run.problem.mesh, event
        change: Change | None = None
        try:
            for move in made:
                said = move(answer)
                if isinstance(said, Change):
                    change = said
                    break
                answer = said
            point = None if change is None else change.point
            # each step is an iteration, and so is another mesh
            if change and len(change.steps) + bool(point and point.problem.mesh is not mesh) <= run.iterations_left:
                yield from change.iterates
                for step in change.steps:
                    before = run.iterate
                    yield run.take(step)
                    if not step.size:  # others have been found by a search, and lower the energy
                        run.rises.change(before, run.iterate)
                run.resolution = change.resolution or run.resolution
                if change.method is not None:
                    run.method, run.memory = change.method, SearchState()
                if point is not None:
                    yield from run.enter(point)
                made = [replace(move) if change.anew and not move.lasts else move for move in made]
                if change.anew or run.problem.mesh is not mesh:
                    event = Start()
                    continue
            elif isinstance(event, Outcome):  # no move leads on, or one needs more iterations than are left
                ending = run.at_limit() if change else run.stopping(answer)
                continue
            event = run.stopping(None if change else answer) or run.step()
            if isinstance(event, Step):
                yield run.accept(event)
        except np.linalg.LinAlgError as error:
            if isinstance(event, Outcome):
                ending = stalled(degenerate(error))
            event = stalled(degenerate(error))
    outcome = run.rises.summarised(ending, run.iterate.index - (run.strand_moves.iterates if run.strand_moves else 0))
    for move in made:
        outcome = move.summarised(outcome)
    return outcome
