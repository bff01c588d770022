"""A run shown in the 3D views as often as drawing allows, and its keys written in slices: the window never waits."""

import contextlib
import threading
import time
from collections.abc import Callable, Iterator

import bpy

from ...core import MobiusFlowError
from ...core.curve import Mesh
from ...core.types import FloatArray
from ..curves.session import Prepared, Report, Session
from ..engine.motion import Proof

_REST = 2.0  # pause after drawing, in multiples of the time that it took: drawing gets a third of the time
_SLICE = 0.02  # seconds of writing at a time


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


class _AbandonedError(Exception):
    """The keys are no longer wanted."""


class KeyWriter:
    """Chooses, proves and writes the keys of a session without ever blocking for long; the proof runs in a thread."""

    def __init__(self, session: Session, proof: Proof) -> None:
        self._session = session
        self._proof = proof
        self._thread = threading.Thread(target=self._prepare, name="Möbius Flow keys", daemon=True)
        self._abandoned = False
        self._prepared: Prepared | None = None
        self._pieces: Iterator[None] | None = None

    def start(self) -> None:
        self._thread.start()

    def abandon(self) -> None:
        """End the thread at its next proof; harmless if there is none."""
        self._abandoned = True

    @property
    def has_begun(self) -> bool:
        """Whether some keys have been written, though perhaps not all."""
        return self._pieces is not None

    def advance(self, seconds: float | None = None) -> Report | None:
        """Write for a time, by default a moment, if the keys are ready, and report once all are written."""
        if self._thread.is_alive():
            return None
        if self._prepared is None:
            raise MobiusFlowError("The keys could not be prepared; all is as it was")
        self._pieces = self._pieces or self._session.writing(self._prepared)
        until = time.perf_counter() + (_SLICE if seconds is None else seconds)
        for _ in self._pieces:
            if time.perf_counter() >= until:
                return None
        return self._session.report(self._prepared)

    def _prepare(self) -> None:
        with contextlib.suppress(_AbandonedError):
            self._prepared = self._session.prepare(self._prove)

    def _prove(self, mesh: Mesh, start: FloatArray, end: FloatArray) -> bool:
        if self._abandoned:
            raise _AbandonedError
        return self._proof(mesh, start, end)
