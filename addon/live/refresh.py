"""How often the shape reached so far is shown: the computation comes first."""

import time
from collections.abc import Callable

_REST = 2.0  # times as long as drawing takes nothing is drawn after it: drawing gets a third of the time


class Refresh:
    """Decides which iterates are shown.

    Parameters
    ----------
    every
        Show every so many iterates; 0: as often as leaves two thirds of the time to anything but drawing.
    clock
        Seconds that pass.
    """

    def __init__(self, every: int = 0, clock: Callable[[], float] = time.perf_counter) -> None:
        self._every, self._clock = every, clock
        self._shown: float | None = None
        self._next = clock()

    def shown(self) -> None:
        """Note that an iterate is being shown; Blender draws it before it sends the next event."""
        self._shown = self._clock()

    def drawn(self) -> None:
        """Note that an event has come: what was shown last has been drawn."""
        if self._shown is not None:
            now = self._clock()
            self._next = now + _REST * (now - self._shown)
            self._shown = None

    def ends_batch(self, index: int) -> bool:
        """Whether an iterate must be shown before the next one is taken in."""
        return self._every > 0 and index % self._every == 0

    def due(self, index: int) -> bool:
        """Whether an iterate, the last one taken in, is to be shown now."""
        return self.ends_batch(index) if self._every else self._clock() >= self._next
