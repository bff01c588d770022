"""A hand that grabs a curve while it relaxes, and drags it."""

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from ..base import MobiusFlowError, checked, shown
from ..curve import MAX_COORDINATE


class Hand:
    """A hand that drags a curve while `relax` runs; it takes instructions between two iterates.

    The curve follows as far as other strands and obstacles leave room, by motions proved like all others, and relaxes
    around the hand; once released it goes on relaxing.  While it is held, iterations do not count, energies exclude the
    hand, and the run does not end: where the curve comes to rest, the run sets ``rests`` and yields its iterate again,
    and it ends only if no instruction follows.

    Parameters
    ----------
    stays
        Whether the run waits in this way wherever it would end, even if the curve is not held.

    Examples
    --------
    >>> from mobius_flow.core import Hand, RelaxOptions, relax
    >>> from mobius_flow.core.knots import knot
    >>> hand = Hand()
    >>> for iterate in relax(knot("3_1"), RelaxOptions(vertices=60), hand=hand):
    ...     if iterate.index == 5:
    ...         hand.grab(0, 0.25)
    ...     if 5 <= iterate.index < 15:
    ...         hand.move([0.1 * (iterate.index - 5), 0, 0])
    ...     if iterate.index == 15:
    ...         hand.release(pin=True)
    >>> iterate.certified, len(iterate.pins)
    (True, 1)
    """

    @checked
    def __init__(self, stays: bool = False) -> None:
        self.stays, self.rests = stays, False
        self.said: list[Callable[[Any], None]] = []  # what the move `Hold` has not carried out yet

    @checked
    def grab(self, component: int, share: float) -> None:
        """Grab a component, counted from 0, at a share of its length from its first vertex on.

        Raises MobiusFlowError if the share is not in [0, 1]; the run raises it if there is no such component.
        """
        if not 0.0 <= share <= 1.0:
            raise MobiusFlowError(f"share is {share}; give a share of the component's length, from 0 to 1")
        self._say(lambda hold: hold.grab(component, share))

    def move(self, target: npt.ArrayLike) -> None:
        """Pull the held part towards a point, shape (m,), in the curve's units; the latest target counts.

        Raises MobiusFlowError if it is no such point; the run raises it if the curve has another dimension.
        """
        try:
            point = np.array(target, dtype=np.float64)
        except (TypeError, ValueError, OverflowError):
            point = np.empty(0)
        if point.ndim != 1 or len(point) < 2 or not np.abs(point).max() <= MAX_COORDINATE:  # NaN is not
            raise MobiusFlowError(f"target is {shown(target)}; give the finite coordinates of a point")
        self._say(lambda hold: hold.move(point))

    @checked
    def release(self, pin: bool = False) -> None:
        """Let go; with a pin, the vertex in the middle of the held part stays where it is from then on."""
        self._say(lambda hold: hold.release(pin))

    def undo(self) -> None:
        """Go back to the iterate before the last grab, as if nothing after it had happened.

        The next iterate takes the number after that one; a `Trajectory` that has the undone ones refuses it.
        """
        self._say(lambda hold: hold.undo())

    def _say(self, what: Callable[[Any], None]) -> None:
        self.rests = False
        self.said.append(what)
