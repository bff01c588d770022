"""What the 3D views show of a run: the newest iterate as often as drawing allows, or where the timeline looks back."""

import time
from collections.abc import Callable

import bpy

_REST = 2.0  # times as long as drawing takes nothing is drawn after it: drawing gets a third of the time


def looks_back() -> bool:
    """Whether somebody plays or scrubs the timeline."""
    screens = (window.screen for window in bpy.context.window_manager.windows)
    return any(screen.is_animation_playing or screen.is_scrubbing for screen in screens)


class Refresh:
    """Decides which iterates are shown: every so many; 0: so that drawing takes at most a third of the time."""

    def __init__(self, every: int = 0, clock: Callable[[], float] = time.perf_counter) -> None:
        self._every, self._clock = every, clock
        self._shown: float | None = None
        self._next = clock()
        self._waited = False  # whether the next iterate is the first one after a pause

    def wait(self) -> None:
        """Let the very next iterate be shown, whatever follows it."""
        self._waited = True

    def shown(self) -> None:
        """Note that an iterate is being shown; Blender draws it before it sends the next event."""
        self._shown, self._waited = self._clock(), False

    def drawn(self) -> None:
        """Note that an event has come: what was shown last has been drawn."""
        if self._shown is not None:
            now = self._clock()
            self._next = now + _REST * (now - self._shown)
            self._shown = None

    def ends_batch(self, index: int) -> bool:
        """Whether an iterate must be shown before the next one is taken in."""
        return self._waited or (self._every > 0 and index % self._every == 0)

    def due(self, index: int) -> bool:
        """Whether an iterate, the last one taken in, is to be shown now."""
        return self.ends_batch(index) or (not self._every and self._clock() >= self._next)
