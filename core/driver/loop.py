"""The loop of a relaxation: an event, what is done about it, the next event."""

from collections.abc import Callable, Generator, Iterator, Sequence

import numpy as np

from ..arguments import checked
from ..curve.places import at_edges
from ..deadline import TimeIsUp, TimeLimit
from ..descent import NoStep, Step
from .events import Change, Event, Start
from .interventions import INTERVENTIONS, Intervention
from .interventions.check_accuracy import with_errors
from .interventions.grow import with_growth
from .iterate import Iterate
from .outcome import Outcome, degenerate, out_of_time, stalled
from .rises import Rises
from .run import Run
from .termination import at_limit, termination

Relaxation = Generator[Iterate, None, Outcome]


class WithOutcome:
    """The iterates of a relaxation for a ``for`` loop, which by itself would lose the outcome.

    Attributes
    ----------
    outcome
        How it ended; None before the loop is through.
    """

    @checked
    def __init__(self, relaxation: Relaxation) -> None:
        self._relaxation = relaxation
        self.outcome: Outcome | None = None

    def __iter__(self) -> Iterator[Iterate]:
        """Yield the iterates that are left."""
        self.outcome = yield from self._relaxation


def within(limit: TimeLimit, relaxation: Relaxation) -> Relaxation:
    """The same until the time is up, also in the middle of a step; what others do between iterates does not count."""
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
            return out_of_time(limit.seconds)
        yield iterate


def iterates(run: Run, interventions: Sequence[Callable[[Run], Intervention]] = INTERVENTIONS) -> Relaxation:
    """Yield the start and every accepted step or change of mesh, each once; return how it ended."""
    rises = Rises()
    yield run.iterate
    outcome = yield from descent(run, rises, interventions)
    return told(outcome, run, rises)


def descent(
    run: Run, rises: Rises, interventions: Sequence[Callable[[Run], Intervention]] = INTERVENTIONS
) -> Relaxation:
    """Yield what comes after the point that a run has reached; return how it ended, without what `told` adds."""
    try:
        return (yield from _descent(run, [make(run) for make in interventions], rises))
    except np.linalg.LinAlgError as error:
        return stalled(degenerate(error))


def told(outcome: Outcome, run: Run, rises: Rises) -> Outcome:
    """The outcome with what is to be said of the whole run."""
    return with_errors(with_growth(rises.told(outcome, run.iterate.index), run), run)


def _descent(run: Run, interventions: Sequence[Intervention], rises: Rises) -> Relaxation:
    event: Event = Start()
    while True:
        answer = _answer(event, interventions)
        if isinstance(answer, Change) and run.allows(answer):
            mesh = run.problem.mesh
            yield from _changed(run, answer, rises)
            if run.problem.mesh is not mesh:
                event = Start()
                continue
        elif isinstance(answer, NoStep):
            limits, curve = answer.limited_by, run.iterate.curve
            return stalled(answer.reason, None if limits is None else at_edges(curve, limits.edges))
        elif isinstance(event, Outcome):
            return answer if isinstance(answer, Outcome) else at_limit(run)
        event = termination(run) or run.step()
        if isinstance(event, Step):
            before = run.iterate
            yield run.accept(event)
            if run.problem.geometry.prescribes:
                rises.step(before, run.iterate)


def _answer(event: Event, interventions: Sequence[Intervention]) -> Event | Change:
    """What the interventions make of an event, one after the other, until one of them changes something."""
    for intervention in interventions:
        answer = intervention(event)
        if isinstance(answer, Change):
            return answer
        event = answer
    return event


def _changed(run: Run, change: Change, rises: Rises) -> Iterator[Iterate]:
    """Make a change; yield the iterates it leads to, if any."""
    for step in change.steps:
        before = run.iterate
        yield run.accept(step)
        rises.change(before, run.iterate)
    before = run.iterate
    remeshed = run.change(change)
    if remeshed is not None:
        rises.change(before, remeshed)
        yield remeshed
