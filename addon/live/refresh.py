"""When what is shown changes: drawing gets a part of the time, and the timeline may show earlier shapes."""

import time
from collections.abc import Callable

import bpy


def looks_back() -> bool:
    """Whether somebody plays or scrubs the timeline."""
    screens = (window.screen for window in bpy.context.window_manager.windows)
    return any(screen.is_animation_playing or screen.is_scrubbing for screen in screens)


class Refresh:
    """Decides which iterates are shown: one in every so many, or for 0 as many as take a third of the time to draw."""

    def __init__(self, every: int = 0, clock: Callable[[], float] = time.perf_counter) -> None:
        self._every, self._clock = every, clock
        self._shown: float | None = None
        self._next = clock()
        self.waited = False  # whether the very next iterate is to be shown, the first one after a pause

    def shown(self) -> None:
        """Note that an iterate is being shown; Blender draws it before it sends the next event."""
        self._shown, self.waited = self._clock(), False

    def drawn(self) -> None:
        """Note that an event has come: what was shown last has been drawn."""
        if self._shown is not None:
            now = self._clock()
            self._next = now + 2.0 * (now - self._shown)  # a pause, so that drawing gets a third of the time
            self._shown = None

    def ends_batch(self, index: int) -> bool:
        """Whether an iterate must be shown before the next one is taken in."""
        return self.waited or (self._every > 0 and index % self._every == 0)

    def due(self, index: int) -> bool:
        """Whether an iterate, the last one taken in, is to be shown now."""
        return self.ends_batch(index) or (not self._every and self._clock() >= self._next)
