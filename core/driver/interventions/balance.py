"""Among the shapes of equal energy that Möbius maps make of a converged curve, the one that bends least."""

from ...curve.bending import bending
from ..balance import GAIN, way_to_balance
from ..events import Change, Event
from ..outcome import Outcome, Status
from ..run import Run
from ..termination import at_limit

BALANCED = "balanced: bending reduced from {before:.4g} to {after:.4g} (4π² for a round circle)"
CUT_OFF = "the Möbius image of least bending has not converged yet"
IS_BALANCED = "no Möbius image within reach bends less"


class Balance:
    """Go from a converged curve to its balanced image, once, and tell of it in the end."""

    def __init__(self, run: Run) -> None:
        self._run = run
        self._before: float | None = None  # bending that the balanced curve had

    def __call__(self, event: Event) -> Event | Change:
        """Look at converged curves, and at ends of the run on the way from one."""
        run = self._run
        if not (run.options.balance and isinstance(event, Outcome)):
            return event
        if event.status is Status.ITERATION_LIMIT and self._before is not None:
            return event.adding(CUT_OFF)
        if not event.converged:
            return event
        if self._before is not None:
            before, after = self._before, bending(run.iterate.curve)
            # on coarse and uneven meshes energies of images differ, and the flow may have gone all the way back
            gained = after <= (1.0 - GAIN) * before
            return event.adding(BALANCED, before=before, after=after) if gained else event.adding(IS_BALANCED)
        steps = way_to_balance(run.point)
        if not steps:
            return event.adding(IS_BALANCED)
        if run.iterations_left <= 0:
            return at_limit(run).adding(CUT_OFF)
        self._before = bending(run.iterate.curve)
        # the method remembers nothing of the curve before
        return Change(steps[: run.iterations_left], method=run.method)
