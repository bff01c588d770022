"""Minimum or saddle: counted where that is asked for, and left downhill."""

from dataclasses import replace

from ...descent import Point, Step
from ...descent.searches import Escape
from ...metrics import MoebiusMetric
from ..events import Change, Event
from ..outcome import Outcome
from ..run import Run
from ..stability import stability

MINIMUM = "a minimum"
ILL_CONDITIONED = "the Hessian is too ill-conditioned to tell a minimum from a saddle"


class EscapeSaddle:
    """Tell the index of a critical point; step off a saddle along its most negative direction."""

    def __init__(self, run: Run) -> None:
        self._run = run

    def __call__(self, event: Event) -> Event | Change:
        """Look at converged curves."""
        options = self._run.options
        if not (isinstance(event, Outcome) and event.converged and (options.stability or options.escape_saddles)):
            return event
        found = stability(self._point())
        event = replace(event, negative_eigenvalues=found.index)
        if not found.index:
            return event.adding(ILL_CONDITIONED if found.index is None else MINIMUM)
        event = event.adding("a saddle of index {index}", index=found.index)
        if not options.escape_saddles:
            return event
        step = Escape().step(self._run.point, found.modes.vectors[0], float(found.modes.values[0]))
        return Change((step,)) if isinstance(step, Step) else event.adding("no step down from it was found")

    def _point(self) -> Point:
        """The present one in J_C, against which eigenvalues are counted whatever metric steps are taken in."""
        point = self._run.point
        if point.problem.metric.name == MoebiusMetric.name:
            return point
        return point.within(replace(point.problem, metric=point.problem.solver.of_metric(MoebiusMetric())))
