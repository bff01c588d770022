"""More vertices where a converged curve's strands are nearer than its mesh resolves."""

from dataclasses import replace

import numpy as np

from ...curve import Curve
from ...curve.distances import arc_distance_of_pairs
from ...curve.refine import STRAND_RATIO
from ...energies.near_pairs import near_pairs
from ...errors import MobiusFlowError
from ..events import Change, Event
from ..outcome import TIGHT, UNRESOLVED, Outcome, stalled
from ..prepare import embedded_refinement, on_mesh
from ..run import Run

FINER = 1.5  # factor of the number of vertices
FINEST = 3.5  # factor of that number at the start from which strands count as pulling tight without limit


class FinerMesh:
    """Go on with more vertices, or say that it would be worth it."""

    def __init__(self, run: Run) -> None:
        self._run = run
        self._limit = FINEST * len(run.point.vertices)

    def __call__(self, event: Event) -> Event | Change:
        """Look at converged curves."""
        curve = self._run.iterate.curve
        if not (isinstance(event, Outcome) and event.converged and _unresolved(curve)):
            return event
        if self._run.options.mesh in ("auto", "fixed"):
            return event.adding(UNRESOLVED)
        finer = self._finer(curve) if len(curve) < self._limit else None
        return finer or stalled(TIGHT.format(vertices=len(curve)))

    def _finer(self, curve: Curve) -> Change | None:
        """The same curve on a finer mesh; None if that cannot be computed with, or has too few digits."""
        vertices = int(np.ceil(FINER * len(curve)))
        try:
            curve = embedded_refinement(curve, vertices)
            point = on_mesh(self._run.problem, curve, replace(self._run.options, vertices=vertices))
        except MobiusFlowError:
            return None
        return Change(point=point, vertices=vertices)


def _unresolved(curve: Curve) -> bool:
    """Whether strands, not merely edges of very different lengths, are so near that the barrier still acts."""
    i, j = near_pairs(curve)
    distance = np.linalg.norm(curve.midpoints[i] - curve.midpoints[j], axis=1)
    return bool(np.any(arc_distance_of_pairs(curve, i, j) > STRAND_RATIO * distance))
