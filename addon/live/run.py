"""One live relaxation: takes in the worker's iterates, shows them in the curve, and ends cleanly whatever happens.

That there is one is known here, in Python, and never in the file. The curve itself moves, so that the window shows
it as it is; what it was is kept and put back unless the run is to be kept.
"""

import threading
import time
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from ...core import Curve, Iterate, MobiusFlowError, RelaxOptions, Status
from ...core.curve import Mesh
from ...core.types import FloatArray
from .. import keyframes
from ..exchange import Placement, write_points
from ..keyframes import KeyOptions
from ..motion import Frame
from ..session import Prepared, Report, Session, State
from . import registry
from .snapshot import Snapshot, outside_edit_mode, shape
from .worker import Worker, WorkerError

if TYPE_CHECKING:
    import bpy

_SLICE = 0.02  # seconds of writing keys at a time


class _NobodyWaitsError(Exception):
    """The run is over; nobody waits for proofs any more."""


class Run:
    """A live relaxation of a curve object.

    Parameters
    ----------
    obj
        A curve object that `checks.refusal` has nothing against, its transforms evaluated.
    options, key_options
        What is asked for.

    Raises
    ------
    MobiusFlowError
        If the curve cannot be relaxed; the message says why.
    """

    def __init__(self, obj: "bpy.types.Object", options: RelaxOptions, key_options: KeyOptions) -> None:
        self.name = obj.name
        self.state = State.RUNNING
        self.message = ""
        self.failed = False
        self.on_end: Callable[[], None] = lambda: None
        self.last: Iterate | None = None
        self.report: Report | None = None
        self._data_uid = obj.data.session_uid
        self._placement = Placement.of(obj)
        self._snapshot = Snapshot(obj.data)
        self._shape = shape(obj.data)
        self._frame: Frame | None = None
        self._writing: Iterator[None] | None = None
        self._prepared: Prepared | None = None
        self._fault = False
        self._session = Session(obj, options, key_options, self._start, self._is_free)
        registry.begin(self)

    def _start(self, curve: Curve, options: RelaxOptions) -> Iterator[Iterate]:
        self._worker = Worker(curve, options, self._placement)
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

    def cancel(self, message: str = "Cancelled; the curve is as it was") -> None:
        """Put the curve back as it was."""
        self._end(State.CANCELLED, message)

    # -- what the timer does ------------------------------------------------------------------------------------

    def tick(self) -> None:
        """Do a little: take in one iterate, or write some keys. Nothing moves while Blender renders."""
        if self.state.over or self.waits:
            return
        try:
            if reason := self._lost():
                self._end(State.LOST, reason)
            elif self.state is State.RUNNING:
                self._take()
            elif self.state is State.FINISHING:
                self._write()
        except MobiusFlowError as error:
            self._fail(str(error))
        except Exception:
            self._fail("Something went wrong; the curve is as it was")
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
        data = self.data
        assert data is not None, "tick looks for it first"
        if self._frame is None:
            self._session.insert_points(data)
            self._shape = shape(data)
        self._frame = frame
        write_points(data, frame)

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
            raise MobiusFlowError("The keys could not be prepared; the curve is as it was")
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

    def _end(self, state: State, message: str) -> None:
        if not self.state.over:
            self._close(state, message)
            self._restore()

    def _close(self, state: State, message: str) -> None:
        self.state, self.message = state, message
        self._worker.close()
        registry.end(self)
        self.on_end()

    def _restore(self) -> None:
        """Put back what was there, even if the object is gone and its data is not, unless someone else changed it."""
        data, obj = self.data, self.object
        if data is None or shape(data) != self._shape or self._foreign_keys(data):
            return
        with outside_edit_mode(obj):
            if obj is not None and obj.data == data and self._writing is not None:
                keyframes.erase(obj)
            self._snapshot.restore(data)

    def set_aside(self) -> None:
        """Put the curve back for a moment, because the file is being saved."""
        if self._frame is not None and self.data is not None and self._writing is None and not self._lost():
            self._snapshot.restore(self.data)

    def put_forward(self) -> None:
        """Show the relaxation again after `set_aside`."""
        data = self.data
        if self._frame is not None and data is not None and self._writing is None and not self.state.over:
            self._session.insert_points(data)
            write_points(data, self._frame)

    @property
    def waits(self) -> bool:
        """Whether Blender renders the curve, which must not move then."""
        import bpy

        return not self.state.over and bool(bpy.app.is_job_running("RENDER"))

    # -- what it works on ---------------------------------------------------------------------------------------

    @property
    def object(self) -> "bpy.types.Object | None":
        """The object, whatever it is called now."""
        return self._session.object

    @property
    def data(self) -> "bpy.types.Curve | None":
        """The curve data, even if the object is gone."""
        import bpy

        return next((data for data in bpy.data.curves if data.session_uid == self._data_uid), None)

    def _lost(self) -> str | None:
        """Say what somebody did to the curve that makes going on impossible."""
        obj, data = self.object, self.data
        if obj is None or data is None or not obj.users_scene:
            return f"'{self.name}' was deleted; its relaxation has ended"
        self.name = obj.name
        if obj.data != data:
            return f"'{self.name}' was given other curve data; its relaxation has ended"
        if obj.mode != "OBJECT":
            return f"'{self.name}' is being edited; its relaxation has ended, and the curve is as it was"
        if shape(data) != self._shape:
            return f"Points of '{self.name}' were added or removed; its relaxation has ended"
        if self._foreign_keys(data):
            return f"'{self.name}' was given shape keys; its relaxation has ended"
        return None

    def _foreign_keys(self, data: "bpy.types.Curve") -> bool:
        """Whether somebody gave the curve shape keys: they fit the points it has now."""
        return data.shape_keys is not None and self._writing is None
