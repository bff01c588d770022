"""The loop of a relaxation: an event, what is done about it, the next event."""

from collections.abc import Generator, Iterator, Sequence

import numpy as np

from ..curve.places import at_edges
from ..descent import NoStep, Step
from .events import Change, Event, Start
from .interventions import INTERVENTIONS, Intervention
from .iterate import Iterate
from .outcome import DEGENERATE, ROSE, Outcome, out_of_iterations, stalled
from .run import Run
from .termination import termination

Relaxation = Generator[Iterate, None, Outcome]


class WithOutcome:
    """The iterates of a relaxation for a ``for`` loop, which by itself would lose the outcome.

    Attributes
    ----------
    outcome
        How it ended; None before the loop is through.
    """

    def __init__(self, relaxation: Relaxation) -> None:
        self._relaxation = relaxation
        self.outcome: Outcome | None = None

    def __iter__(self) -> Iterator[Iterate]:
        """Yield the iterates that are left."""
        self.outcome = yield from self._relaxation


def iterates(run: Run) -> Relaxation:
    """Yield the start and every accepted step or change of mesh, each once; return how it ended."""
    try:
        outcome = yield from _iterates(run, [make(run) for make in INTERVENTIONS])
    except np.linalg.LinAlgError as error:
        outcome = stalled(DEGENERATE.format(error=error))
    rises = run.rises
    if rises:
        outcome = outcome.adding(ROSE.format(count=len(rises), steps=run.iterate.index, total=sum(rises)))
    return outcome


def _iterates(run: Run, interventions: Sequence[Intervention]) -> Relaxation:
    yield run.iterate
    event: Event = Start()
    while True:
        answer = _answer(event, interventions)
        if isinstance(answer, Change) and not (run.at_limit and answer.step):
            mesh = run.problem.mesh
            yield from _changed(run, answer)
            if run.problem.mesh is not mesh:
                event = Start()
                continue
        elif isinstance(answer, NoStep):
            limits, curve = answer.limited_by, run.iterate.curve
            return stalled(answer.reason, None if limits is None else at_edges(curve, limits))
        elif isinstance(event, Outcome):
            return answer if isinstance(answer, Outcome) else out_of_iterations(run.iterate.index)
        event = termination(run) or run.step()
        if isinstance(event, Step):
            yield run.accept(event)


def _answer(event: Event, interventions: Sequence[Intervention]) -> Event | Change:
    """What the interventions make of an event, one after the other, until one of them changes something."""
    for intervention in interventions:
        answer = intervention(event)
        if isinstance(answer, Change):
            return answer
        event = answer
    return event


def _changed(run: Run, change: Change) -> Iterator[Iterate]:
    """Make a change; yield the iterates it leads to, if any."""
    if change.step is not None:
        yield run.accept(change.step)
    iterate = run.change(change)
    if iterate is not None:
        yield iterate
