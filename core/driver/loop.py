"""The loop of a relaxation: an event, what is done about it, the next event."""

from collections.abc import Callable, Generator, Iterator, Sequence

import numpy as np

from ..arguments import checked
from ..curve import at_edges
from ..deadline import TimeIsUp, TimeLimit
from ..descent import NoStep, Step
from ..messages import Message
from .hand import Hold
from .interventions import INTERVENTIONS
from .interventions.fallback import with_errors
from .interventions.grow import with_growth
from .outcome import Outcome, Status, degenerate, stalled
from .run import Change, Event, Intervention, Run, Start
from .trajectory import Iterate

Relaxation = Generator[Iterate, None, Outcome]


class WithOutcome:
    """The iterates of a relaxation, with the ``outcome`` that a ``for`` loop would lose: None until the end."""

    @checked
    def __init__(self, relaxation: Relaxation) -> None:
        self._relaxation = relaxation
        self.outcome: Outcome | None = None

    def __iter__(self) -> Iterator[Iterate]:
        self.outcome = yield from self._relaxation


def within(limit: TimeLimit, relaxation: Relaxation) -> Relaxation:
    """The same until the time is up, even in the middle of a step; time between iterates does not count."""
    while True:
        try:
            with limit:
                iterate = next(relaxation)
        except StopIteration as end:
            outcome: Outcome = end.value
            return outcome
        except TimeIsUp as up:
            if up.limit is not limit:
                raise
            reached = Message("stopped at the time limit ({seconds:g} s)", seconds=limit.seconds)
            return Outcome(Status.TIME_LIMIT, (reached,)).noting(up)
        yield iterate


def iterates(run: Run, interventions: Sequence[Callable[[Run], Intervention]] | None = None) -> Relaxation:
    """Yield the start and every accepted step or change of mesh, each once; return how it ended."""
    yield run.iterate
    outcome = yield from descent(run, interventions)
    return summarised(outcome, run)


def descent(
    run: Run, interventions: Sequence[Callable[[Run], Intervention]] | None = None, hold: Hold | None = None
) -> Relaxation:
    """Yield the iterates after the point that a run has reached; return how it ended, without the run's summary."""
    kinds = INTERVENTIONS if interventions is None else interventions
    made = [make(run) for make in kinds]
    try:
        return (yield from _descent(run, made if hold is None else [hold, *made, hold.ending]))
    except np.linalg.LinAlgError as error:
        return stalled(degenerate(error))


def summarised(outcome: Outcome, run: Run) -> Outcome:
    """The outcome with clauses about the whole run."""
    steps = run.iterate.index - (run.strand_moves.iterates if run.strand_moves else 0)
    return with_errors(with_growth(run.rises.summarised(outcome, steps), run), run)


def _descent(run: Run, interventions: Sequence[Callable[[Event], Event | Change]]) -> Relaxation:
    event: Event = Start()
    while True:
        mesh = run.problem.mesh
        answer = _answer(event, interventions)
        if isinstance(answer, Change) and run.allows(answer):
            yield from run.change(answer)
            if run.problem.mesh is not mesh:
                event = Start()
                continue
        elif isinstance(answer, NoStep):
            limits, curve = answer.limited_by, run.iterate.curve
            return stalled(answer.reason, None if limits is None else at_edges(curve, limits.edges))
        elif isinstance(event, Outcome):
            return answer if isinstance(answer, Outcome) else run.at_limit()
        event = run.termination() or run.step()
        if isinstance(event, Step):
            yield run.accept(event)


def _answer(event: Event, interventions: Sequence[Callable[[Event], Event | Change]]) -> Event | Change:
    """Pass an event through the interventions in turn, until one of them answers with a change."""
    for intervention in interventions:
        answer = intervention(event)
        if isinstance(answer, Change):
            return answer
        event = answer
    return event
