"""Shorter edges where a converged curve's strands are nearer than its mesh resolves."""

from dataclasses import replace

import numpy as np

from ...curve import Curve
from ...curve.distances import arc_distance_of_pairs
from ...curve.refine import STRAND_RATIO, affordable_pieces, subdivide
from ...curve.remesh import graded_spacing
from ...energies.barrier import near_pairs
from ...errors import MobiusFlowError
from ...task import check_refined
from ..events import Change, Event
from ..outcome import UNRESOLVED, Outcome
from ..run import Run

EDGES_PER_GAP = 6.0  # the barrier acts below 3: strands may draw nearer by half; energies are within some 0.1 % then
FINEST = 10_000  # vertices, unless there are more: what the hierarchical solver has time for
MIN_ITERATIONS = 5  # that are left: it takes two or three to get back what corners cost when their edges are split


class FinerMesh:
    """Split edges near other strands and go on, or say that it would be worth it."""

    def __init__(self, run: Run) -> None:
        self._run = run
        self._resolution = replace(run.resolution, edges_per_gap=EDGES_PER_GAP)

    def __call__(self, event: Event) -> Event | Change:
        """Look at converged curves."""
        curve = self._run.iterate.curve
        if not (isinstance(event, Outcome) and event.converged and _unresolved(curve)) or self._run.frozen:
            return event
        return (self._finer(curve) if self._is_wanted else None) or event.adding(UNRESOLVED)

    @property
    def _is_wanted(self) -> bool:
        return self._run.options.ends_finer and self._run.iterations_left >= MIN_ITERATIONS

    def _finer(self, curve: Curve) -> Change | None:
        """The same curve on a finer mesh; None if that cannot be computed with, or has too few digits."""
        finer = subdivide(curve, affordable_pieces(curve, graded_spacing(curve, self._resolution), FINEST))
        if len(finer) == len(curve):
            return None
        try:
            check_refined(curve, finer, self._run.problem.obstacles)
            point = self._run.problem.on(finer)  # its lengths, shorter near strands as they are, need no evening out
        except MobiusFlowError:
            return None
        return Change(point=point, resolution=self._resolution)


def _unresolved(curve: Curve) -> bool:
    """Whether strands, not merely edges of very different lengths, are so near that the barrier still acts."""
    i, j = near_pairs(curve)
    distance = np.linalg.norm(curve.midpoints[i] - curve.midpoints[j], axis=1)
    return bool(np.any(arc_distance_of_pairs(curve, i, j) > STRAND_RATIO * distance))
