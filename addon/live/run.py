"""One live relaxation: takes in the worker's iterates, shows them in the curves, and ends cleanly whatever happens.

The objects show what has been reached; their originals come back unless the run is kept.
"""

import math
import time
from collections.abc import Callable
from enum import Enum
from functools import cached_property

import bpy
import numpy as np

from ...core import CurveError, Iterate, MobiusFlowError, Outcome, Status
from ...core.driver import TimeLeft
from ...core.errors import Place
from ...core.messages import Message
from ...core.types import FloatArray
from ..curves.group import Group
from ..curves.session import Report, Session
from ..curves.splines import digest
from ..engine.placement import Spot
from ..engine.rest import Target, target_of
from ..engine.worker import Worker, WorkerError
from ..pictures.rendering import is_rendering
from .drag import Drag
from .viewing import KeyWriter, Refresh, looks_back

_CANCELLED = Message("Cancelled; all is as it was")
_SLICE = 0.02  # seconds of taking in iterates at a time


class State(Enum):
    RUNNING = Message("Running")
    PAUSED = Message("Paused")
    FINISHING = Message("Finishing")
    DONE = Message("Done")
    CANCELLED = Message("Cancelled")
    LOST = Message("Interrupted")

    @property
    def over(self) -> bool:
        return self in (State.DONE, State.CANCELLED, State.LOST)


class Run:
    """A session that is fed by a worker, while its curves are shown."""

    def __init__(self, session: Session, refresh: Refresh, stays: bool = False) -> None:
        self.state = State.RUNNING
        self.message, self.failed = "", False  # the message about its end
        self.on_end: Callable[[], None] = lambda: None
        self.last: Iterate | None = None
        self.report: Report | None = None
        self.shown: Iterate | None = None  # the newest one, unless the timeline
        self.looked_at: float | None = None  # looks back at another: its number
        self.energies: list[float] = []
        self.drag: Drag | None = None  # the one that is going on
        self.drags = 0  # those that may be taken back
        self.trouble: list[Spot] = []  # where it failed or got stuck, if the reason has a place
        self._left: dict[int, bytes] | None = None  # what the objects were at its end, by their identities
        self._session, self._refresh = session, refresh
        self.time_left = TimeLeft(session.options)
        try:
            self._worker = Worker(session.task, session.options, self.group.link, stays, session.goals.curves)
        except BaseException:
            self.group.discard()
            raise
        self._keys = KeyWriter(self._session, self._worker.is_free)

    @property
    def group(self) -> Group:
        return self._session.group

    @property
    def name(self) -> str:
        return self.group.title

    @property
    def avoided(self) -> tuple[str, ...]:
        return self._session.surroundings.names

    @cached_property
    def target(self) -> Target | None:
        return target_of(self._session.task, self._session.options)

    def concerns(self, obj: bpy.types.Object | None) -> bool:
        """Whether it concerns an object: always while in progress, afterwards if the object is as the run left it."""
        if self._left is None:
            return True
        return obj is not None and obj.type == "CURVE" and self._left.get(obj.session_uid) == digest(obj.data)

    @property
    def spots(self) -> dict[bpy.types.Object, Spot]:
        """The places of trouble by object, for the objects that still exist."""
        found = {self.group.member(spot.member): spot for spot in self.trouble}
        return {obj: spot for obj, spot in found.items() if obj is not None}

    @property
    def waits(self) -> bool:
        """Whether it waits for a render, during which curves must not move."""
        return not self.state.over and is_rendering()

    @property
    def endures(self) -> bool:
        """Whether it survives an undo of something else."""
        return self.state in (State.RUNNING, State.PAUSED)

    def toggle_pause(self) -> None:
        """Stop, or go on with the next iterate; during a pause the worker waits too."""
        if self.endures:
            self._show()
            self._refresh.wait()
            self.time_left.restart()
            self.state = State.PAUSED if self.state is State.RUNNING else State.RUNNING
            self._worker.tell("pause", self.state is State.PAUSED)

    def look(self) -> None:
        """Show the shape that the scene's frame would have if the run ended here, while the timeline is used."""
        if self.last is None or self.state.over or self.waits or self._session.lost():
            return
        there = self._session.at(bpy.context.scene.frame_current_final) if self.endures and looks_back() else None
        before, self.looked_at = self.looked_at, None if there is None else there.time
        if there is not None and there.time != before:
            self._session.show(there)
            self.shown = None
        elif there is None and self.shown is None:
            self._show()

    def grab(self, drag: Drag) -> None:
        """Take hold of a strand; `pull` and `let_go` follow."""
        self.drag, self.drags = drag, self.drags + 1
        self._worker.tell("grab", drag.component, drag.share)

    def pull(self, target: FloatArray) -> None:
        """Pull what is held to a place in view, shape (3,)."""
        if self.drag is not None and self.group.in_view is not None and np.isfinite(target).all():
            self.drag.target = target
            place = self._session.motion.unsized(self.group.unmoved(self.drag.component, target))
            self._worker.tell("move", place.tolist())

    def let_go(self, pin: bool = False) -> None:
        """Let go of the strand; with a pin it stays there, and the curve is scaled no more to keep its size."""
        self.drag = None
        self.time_left.restart()
        self._worker.tell("release", pin)

    def take_back(self) -> None:
        """Go back to before the last drag, if there was one."""
        self.drag = None
        if self.drags:
            self.drags -= 1
            self._worker.tell("undo")

    def keep(self, reason: str = "") -> None:
        """Keep the curve as it is now: stop computing, then prove and write the keys."""
        if self.state not in (State.RUNNING, State.PAUSED):
            return
        if self.last is None:
            self.cancel(Message("Stopped before anything had moved"))
            return
        self.looked_at = self.drag = None
        self._show()
        if self._session.outcome is None:
            reason = reason or Message("stopped after {count} iterations", count=self.last.index)
            self._session.outcome = Outcome(Status.INTERRUPTED, (reason,))
        self.state = State.FINISHING
        self._worker.close()
        self._keys.start()

    def cancel(self, message: str = _CANCELLED) -> None:
        if not self.state.over:
            self._close(State.CANCELLED, message)

    @property
    def recoverable(self) -> bool:
        """Whether it ended with the curves put back, while its iterates are still known."""
        return self.state in (State.CANCELLED, State.LOST) and self.last is not None

    def recover(self) -> None:
        """Keep what a cancelled run had reached; raises MobiusFlowError if the curves have changed since."""
        self._session.reopen()
        self._keys = KeyWriter(self._session, self._worker.is_free)
        self.state, self.message, self.failed, self.shown = State.RUNNING, "", False, None
        self.trouble, self._left = [], None
        self.keep()

    def tick(self) -> None:
        """Do a little: take in some iterates, or write some keys. Nothing moves while Blender renders."""
        if not (self.state.over or self.waits):
            self.look()
            self._advance()

    def complete(self) -> None:
        """Finish writing keys once begun: a saved file must not hold half of them."""
        if self.state is State.FINISHING and self._keys.has_begun:
            self._advance(math.inf)

    def _advance(self, seconds: float | None = None) -> None:
        """Take in some iterates, or write keys for so long, by default a moment; end the run if that fails."""
        try:
            if reason := self._session.lost():
                self._lose(reason)
            elif self.state is State.RUNNING:
                self._take()
            elif self.state is State.FINISHING:
                self._write(self._keys.advance(seconds))
        except MobiusFlowError as error:
            self._fail(str(error), error.place if isinstance(error, CurveError) else None)
        except MemoryError:
            self._fail(Message("Memory ran out; all is as it was"))
        except Exception:
            self._fail(Message("Something went wrong; all is as it was"))
            raise

    def _take(self) -> None:
        """Take in all iterates that have arrived up to the next one to be shown; the last of them is shown."""
        self._refresh.drawn()
        until = time.perf_counter() + _SLICE
        while self.state is State.RUNNING and time.perf_counter() < until:
            arrived = self._poll()
            if arrived is None:
                break
            if isinstance(arrived, Outcome):
                self._session.end(arrived)
                self.keep()
                return
            self._session.take(arrived)
            self.last = arrived
            self.time_left.add(arrived)
            self.energies[arrived.index :] = [arrived.energy]
            if self._refresh.ends_batch(arrived.index):
                break
        if self.last is not None and self._refresh.due(self.last.index):
            self._show()

    def _poll(self) -> Iterate | Outcome | None:
        try:
            return self._worker.poll()
        except CurveError as error:
            raise self._session.reworded(error) from error
        except WorkerError as error:
            if self.last is None:
                raise
            self.failed = True
            self.keep(str(error))
            return None

    def _show(self) -> None:
        if self.last is not None and self.last is not self.shown and self.looked_at is None:
            self._session.show()
            self.shown = self.last
            self._refresh.shown()

    def _write(self, report: Report | None) -> None:
        self.report = report
        if report is not None:
            assert self.last is not None, "it was kept"
            self.trouble = self.group.spots(report.outcome.place, self.last.curve)
            self._close(State.DONE, report.sentence, discard=False)

    def _fail(self, message: str, place: Place | None = None) -> None:
        self.failed = True
        self.trouble = self.group.spots(place, self.group.curve)
        self.cancel(message)

    def _lose(self, reason: Message) -> None:
        """End because an object was changed from outside; the others are put back."""
        ended = Message("{reason}; the relaxation has ended", reason=reason)
        restored = self._close(State.LOST, ended)
        more = Message("and every curve is as it was") if restored else Message("and the others are as they were")
        if restored or len(self.group.names) > 1:
            self.message = Message("{ended}, {more}", ended=ended, more=more)

    def _close(self, state: State, message: str, discard: bool = True) -> bool:
        """End, putting the curves back or not; return whether all are as they were."""
        self.state, self.message, self.drag = state, message, None
        self._worker.close()
        self._keys.abandon()
        self.on_end()
        restored = discard and self.group.discard()
        self._left = {obj.session_uid: digest(obj.data) for obj in self.group.objects}
        return restored
