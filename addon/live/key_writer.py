"""The keys of a run that is kept: proved in a thread, written in slices, so that the window stays alive."""

import contextlib
import threading
import time
from collections.abc import Iterator

from ...core import MobiusFlowError
from ...core.curve import Mesh
from ...core.types import FloatArray
from ..curves.session import Prepared, Report, Session
from ..engine.motion import Proof

_SLICE = 0.02  # seconds of writing at a time


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
        """Whether some keys are written, and perhaps not all."""
        return self._pieces is not None

    def advance(self, seconds: float | None = None) -> Report | None:
        """Write for so long, by default a moment, if the keys are ready, and report once all are written."""
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
