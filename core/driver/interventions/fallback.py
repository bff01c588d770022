"""Another method takes some steps where the one asked for finds none."""

import math

from ...descent import METHODS, NoStep
from ..events import Change, Event
from ..run import Run

HELPER = METHODS["flow-h3-2"]  # its metric does not see how near strands are, and so does not hold them together
HELPS = 10  # steps that it takes
PROGRESS = 1e-6  # relative decrease of energy without which asking it again is no use


class Fallback:
    """Hand over to the helper where no step is found, and back after some steps."""

    def __init__(self, run: Run) -> None:
        self._run, self._asked_for = run, run.method
        self._mesh = run.problem.mesh
        self._until = 0  # iterate at which the helper has done enough
        self._helped_at = math.inf  # energy at which it was asked last, on the present mesh

    def __call__(self, event: Event) -> Event | Change:
        """Change the method."""
        run = self._run
        if run.problem.mesh is not self._mesh:
            self._mesh, self._helped_at = run.problem.mesh, math.inf
        stuck = isinstance(event, NoStep)
        if run.method is not self._asked_for:
            return Change(method=self._asked_for) if stuck or run.iterate.index >= self._until else event
        if not (stuck and self._may_help and run.point.energy < (1.0 - PROGRESS) * self._helped_at):
            return event
        self._until, self._helped_at = run.iterate.index + HELPS, run.point.energy
        return Change(method=HELPER)

    @property
    def _may_help(self) -> bool:
        run = self._run
        count = len(run.point.vertices)
        fits = count <= run.problem.solver.of_metric(HELPER.metric).most_vertices
        return fits and run.problem.geometry.prescribes and self._asked_for is not HELPER
