"""Basin hopping (Wales and Doye 1997): from minimum to lower minimum, by motions proved like all others."""

import numpy as np

from ...errors import counted
from ..loop import Relaxation, descent, told
from ..outcome import Outcome
from ..rises import Rises
from ..run import Run
from .motions import MOTIONS
from .trial import Trial, trial
from .unknot import is_circle, told_of_unknot

GAIN = 1e-3  # relative decrease of the objective that counts: vertices sliding along a curve change it by about as much
HOPS = "{taken} of {tried} led lower"
MAY_HELP, MORE_MAY_HELP = "hops may find the way", "more hops may find the way"


def hopping(run: Run) -> Relaxation:
    """Yield the iterates of a relaxation and of its hops; return how it ended.

    A hop is one iterate: the motion, and the relaxation down to where less energy is left than at the minimum before.
    Whoever stops between two iterates has the lowest curve so far.
    """
    rises, hops = Rises(), Hops(run)
    yield run.iterate
    outcome = yield from descent(run, rises)
    while hops.led_lower(outcome):
        yield run.iterate
        outcome = yield from descent(run, rises)
    return hops.told(told(outcome, run, rises))


class Hops:
    """The hops of one run, counted."""

    def __init__(self, run: Run) -> None:
        self._run = run
        self._rng = np.random.default_rng(run.options.seed)
        self._tried = self._taken = 0

    def led_lower(self, outcome: Outcome) -> bool:
        """Try until a hop leads lower, which the run then takes; False if none does, or there is nothing lower."""
        run = self._run
        if not outcome.may_be_left or (run.problem.unconfined and is_circle(run.iterate.curve)):
            return False
        while self._tried < run.options.hops and run.iterations_left > 0:
            below = (1.0 - GAIN) * run.iterate.energy
            found = self._next(below)
            if found is not None and found.run.iterate.energy < below:
                run.hop(found.run, found.path, found.certified)
                self._taken += 1
                return True
        return False

    def _next(self, below: float) -> Trial | None:
        """The next trial, motions taking turns; None if numbers fail on the way, or no motion is for this curve."""
        run = self._run
        motions = [motion for motion in MOTIONS if motion.fits(run.point)]
        self._tried += 1
        try:
            found = trial(run, motions[self._tried % len(motions)], self._rng, below)
        except np.linalg.LinAlgError:
            return None
        run.tried(found.iterations)
        return found

    def told(self, outcome: Outcome) -> Outcome:
        """The outcome with what hops were good for, or may be."""
        if self._tried:
            outcome = outcome.adding(HOPS.format(taken=self._taken, tried=counted(self._tried, "hop")))
        run = self._run
        found = told_of_unknot(run.iterate.curve) if outcome.may_be_left and run.problem.unconfined else None
        if found is None:
            return outcome
        return outcome.adding(f"{found}: {MORE_MAY_HELP if self._run.options.hops else MAY_HELP}")
