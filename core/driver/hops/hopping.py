"""Basin hopping (Wales and Doye 1997): from minimum to lower minimum, by motions proved like all others."""

import numpy as np

from ...energies.components import energy_scale
from ..loop import Relaxation, descent, told
from ..outcome import Outcome
from ..rises import Rises
from ..run import Run
from .motions import MOTIONS, Motion
from .trial import Trial, trial
from .unknot import is_circle, told_of_unknot

GAIN = 1e-3  # relative decrease of the objective that counts: vertices sliding along a curve change it by about as much


def hopping(run: Run) -> Relaxation:
    """Yield the iterates of a relaxation and of its hops; return how it ended.

    A hop is one iterate: its path is the motion, and the relaxation to where there is less energy than at the minimum
    before.  So whoever stops between two iterates has the lowest curve so far.
    """
    rises, hops = Rises(), Hops(run)
    yield run.iterate
    outcome = yield from descent(run, rises)
    while hops.led_lower(outcome):
        yield run.iterate
        outcome = yield from descent(run, rises)
    return hops.told(told(outcome, run, rises))


class Hops:
    """The hops of one run; their motions take turns."""

    def __init__(self, run: Run) -> None:
        self._run = run
        self._rng = np.random.default_rng(run.options.seed)
        self._tried = self._taken = 0

    def led_lower(self, outcome: Outcome) -> bool:
        """Try until a hop leads lower, which the run then takes; False if none does, or there is nothing lower."""
        run = self._run
        motions = [motion for motion in MOTIONS if motion.fits(run.point)]
        if run.frozen or not (outcome.may_be_left and motions):
            return False
        if run.problem.unconfined and is_circle(run.iterate.curve):
            return False
        while self._tried < run.options.hops and run.iterations_left > 0:
            below = run.iterate.energy - GAIN * energy_scale(run.problem.mesh, run.iterate.energy)
            if below < 0.0:  # arcs that are straight
                return False
            found = self._next(motions[self._tried % len(motions)], below)
            if found is None:
                continue
            lower = found.run.iterate.energy < below
            run.count_tried(found.iterations - lower)  # the hop itself is one iterate
            if lower:
                run.hop(found.run.point, found.path, found.certified)
                self._taken += 1
                return True
        return False

    def _next(self, motion: Motion, below: float) -> Trial | None:
        """The next trial, which begins with a motion; None if numbers fail on the way."""
        self._tried += 1
        try:
            return trial(self._run, motion, self._rng, below)
        except np.linalg.LinAlgError:
            return None

    def told(self, outcome: Outcome) -> Outcome:
        """The outcome with what hops were good for, or what they may be good for."""
        if self._tried:
            outcome = outcome.adding(
                "hops that lowered the energy: {taken} of {tried}", taken=self._taken, tried=self._tried
            )
        run = self._run
        unknot = told_of_unknot(run.iterate.curve) if outcome.may_be_left and run.problem.unconfined else None
        if unknot is None:
            return outcome
        more = "{unknot}: more hops may reach it" if run.options.hops else "{unknot}: hops may reach it"
        return outcome.adding(more, unknot=unknot)
