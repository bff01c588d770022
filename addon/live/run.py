"""One live relaxation: takes in the worker's iterates, shows them in the curves, and ends cleanly whatever happens.

That there is one is known here, in Python, and never in the file. The curves themselves move, so that the window
shows them as they are; what they were is kept and put back unless the run is to be kept.
"""

import threading
import time
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

from ...core import Curve, Iterate, MobiusFlowError, RelaxOptions, Status
from ...core.curve import Mesh
from ...core.types import FloatArray
from ..group import Group
from ..key_options import KeyOptions
from ..placement import Frame
from ..session import Prepared, Report, Session, State
from . import registry
from .worker import Worker, WorkerError

if TYPE_CHECKING:
    import bpy

_SLICE = 0.02  # seconds of writing keys at a time


class _NobodyWaitsError(Exception):
    """The run is over; nobody waits for proofs any more."""


class Run:
    """A live relaxation of curve objects as one link.

    Parameters
    ----------
    objects
        Curve objects that `checks.refusal` has nothing against, their transforms evaluated.
    options, key_options
        The requested options.

    Raises
    ------
    MobiusFlowError
        If the curves cannot be relaxed; the message says why.
    """

    def __init__(self, objects: Sequence["bpy.types.Object"], options: RelaxOptions, key_options: KeyOptions) -> None:
        self.state = State.RUNNING
        self.message = ""
        self.failed = False
        self.on_end: Callable[[], None] = lambda: None
        self.last: Iterate | None = None
        self.report: Report | None = None
        self.group = Group(objects)
        self._frame: Frame | None = None
        self._writing: Iterator[None] | None = None
        self._prepared: Prepared | None = None
        self._fault = False
        self._session = Session(self.group, options, key_options, self._start, self._is_free)
        registry.begin(self)

    @property
    def name(self) -> str:
        """The names of the objects, as messages show them."""
        return self.group.title

    def _start(self, curve: Curve, options: RelaxOptions) -> Iterator[Iterate]:
        self._worker = Worker(curve, options, self.group.link)
        return iter(self._worker)

    def _is_free(self, mesh: Mesh, start: FloatArray, end: FloatArray) -> bool:
        if self.state.over:
            raise _NobodyWaitsError
        return self._worker.is_free(mesh, start, end)

    # -- what the buttons do ------------------------------------------------------------------------------------

    def pause(self) -> None:
        """Show no more iterates; the worker fills its queue and then waits too."""
        if self.state is State.RUNNING:
            self.state = State.PAUSED

    def resume(self) -> None:
        """Go on after a pause."""
        if self.state is State.PAUSED:
            self.state = State.RUNNING

    def keep(self, reason: str = "") -> None:
        """Keep the curve as it is now: stop computing, then prove and write the keys."""
        if self.state not in (State.RUNNING, State.PAUSED):
            return
        if self.last is None:
            self.cancel("Stopped before anything had moved")
            return
        if self.last.status is Status.RUNNING:
            self._session.interrupt(reason or f"stopped after {self.last.index} iterations")
        self.state = State.FINISHING
        self._worker.close()
        threading.Thread(target=self._prepare, name="Möbius Flow keys", daemon=True).start()

    def cancel(self, message: str = "Cancelled; all is as it was") -> None:
        """Put the curve back as it was."""
        if not self.state.over:
            self._close(State.CANCELLED, message)
            self.group.restore()

    # -- what the timer does ------------------------------------------------------------------------------------

    def tick(self) -> None:
        """Do a little: take in one iterate, or write some keys. Nothing moves while Blender renders."""
        if self.state.over or self.waits:
            return
        try:
            if reason := self.group.lost():
                self._lose(f"{reason}; the relaxation has ended")
            elif self.state is State.RUNNING:
                self._take()
            elif self.state is State.FINISHING:
                self._write()
        except MobiusFlowError as error:
            self._fail(str(error))
        except MemoryError:
            self._fail("Memory ran out; all is as it was")
        except Exception:
            self._fail("Something went wrong; all is as it was")
            raise

    def _take(self) -> None:
        try:
            iterate = self._worker.poll()
        except WorkerError as error:
            if self.last is None:
                raise
            self.failed = True
            self.keep(str(error))
            return
        if iterate is None:
            return
        self.last = iterate
        self._show(self._session.take(iterate))
        if iterate.status is not Status.RUNNING:
            self.keep()

    def _show(self, frame: Frame) -> None:
        if self._frame is None:
            self._session.make_polygons()
        self._frame = frame
        self._session.show(frame)

    def _prepare(self) -> None:
        try:
            self._prepared = self._session.prepare()
        except _NobodyWaitsError:
            return
        except BaseException:
            self._fault = True
            raise

    def _write(self) -> None:
        if self._fault:
            raise MobiusFlowError("The keys could not be prepared; all is as it was")
        if self._prepared is None:
            return
        self._writing = self._writing or self._session.writing(self._prepared)
        until = time.perf_counter() + _SLICE
        while time.perf_counter() < until:
            try:
                next(self._writing)
            except StopIteration:
                self._done(self._prepared)
                return

    def _done(self, prepared: Prepared) -> None:
        self.report = self._session.report(prepared)
        self._close(State.DONE, self.report.sentence)

    # -- ends ---------------------------------------------------------------------------------------------------

    def _fail(self, message: str) -> None:
        self.failed = True
        self.cancel(message)

    def _lose(self, message: str) -> None:
        """End because of what somebody did to an object; what else there is is put back."""
        self._close(State.LOST, message)
        if self.group.restore():
            self.message += ", and every curve is as it was"
        elif len(self.group.names) > 1:
            self.message += ", and the others are as they were"

    def _close(self, state: State, message: str) -> None:
        self.state, self.message = state, message
        self._worker.close()
        registry.end(self)
        self.on_end()

    def set_aside(self) -> None:
        """Put the curves back for a moment, because the file is being saved."""
        if self._frame is not None and self._writing is None:
            self.group.set_aside()

    def put_forward(self) -> None:
        """Show the relaxation again after `set_aside`."""
        if self._frame is not None and self._writing is None and not self.state.over:
            self._session.make_polygons()
            self._session.show(self._frame)

    @property
    def waits(self) -> bool:
        """Whether Blender renders the curve, which must not move then."""
        import bpy

        return not self.state.over and bool(bpy.app.is_job_running("RENDER"))
