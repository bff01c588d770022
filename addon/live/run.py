"""One live relaxation: takes in the worker's iterates, shows them in the curves, and ends cleanly whatever happens.

The objects show what has been reached; their originals come back unless the run is kept.
"""

import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor, wait
from enum import Enum
from functools import cached_property
from typing import Any

import bpy
import numpy as np

from ...core import CurveError, Iterate, MobiusFlowError, Outcome, Status
from ...core.base import FloatArray, Message, Place
from ...core.driver import TimeLeft
from ...core.keys.placement import Spot
from ...core.ropes import TightenOptions
from ..curves.report import Report
from ..curves.session import Prepared, Session
from ..curves.splines import digest
from ..engine.rest import Target, target_of
from ..engine.worker import Worker, WorkerError
from ..pictures.rendering import is_rendering
from .drag import Drag
from .refresh import Refresh, looks_back


class RunState(Enum):
    RUNNING = Message("Running")
    PAUSED = Message("Paused")
    FINISHING = Message("Finishing")
    DONE = Message("Done")
    CANCELLED = Message("Cancelled")
    LOST = Message("Interrupted")

    @property
    def over(self) -> bool:
        return self in (RunState.DONE, RunState.CANCELLED, RunState.LOST)


class LiveRun:
    """A session that is fed by a worker, while its curves are shown."""

    slice = 0.02  # seconds of taking in iterates at a time

    def __init__(self, session: Session, refresh: Refresh, stays: bool = False) -> None:
        self.state = RunState.RUNNING
        self.message, self.failed = "", False  # the message about its end
        self.on_end: Callable[[], None] = lambda: None
        self.last: Iterate | None = None
        self.report: Report | None = None
        self.shown: Iterate | None = None  # the newest one, unless the timeline
        self.looked_at: float | None = None  # looks back at another: its number
        self.energies: list[float] = []
        self.drag: Drag | None = None  # the one that is going on
        self.drags = 0  # those that may be taken back
        self.stops = False  # whether the worker was told to, before there was anything to keep
        self.trouble: list[Spot] = []  # where it failed or got stuck, if the reason has a place
        self._left: dict[int, bytes] | None = None  # what the objects were at its end, by their identities
        self.session, self._refresh = session, refresh
        self.avoided = session.surroundings.names
        self.time_left = TimeLeft(session.options)
        with session.all_or_nothing():
            self._worker = Worker(session.task, session.job, stays, session.goals.curves)
        self._keys: Future[Prepared] | None = None  # chosen and proved in a thread, while Blender stays usable

    @property
    def objects(self) -> list[bpy.types.Object]:
        """The objects that it is about: those that move, and those that they become."""
        return [*self.session.objects, *self.session.goals.objects]

    @property
    def name(self) -> str:
        return self.session.title

    @property
    def measure(self) -> Message:
        """What the ``energies`` are."""
        return Message("Length in Radii" if isinstance(self.session.job, TightenOptions) else "Energy")

    @property
    def _relaxes(self) -> bool:
        """Whether it lowers an energy: ropes are separated or tightened by other rules."""
        return self.session.job is self.session.options

    @cached_property
    def target(self) -> Target | None:
        return target_of(self.session.task, self.session.options) if self._relaxes else None

    def concerns(self, obj: bpy.types.Object | None) -> bool:
        """Whether it concerns an object: always while in progress, afterwards if the object is as the run left it."""
        if self._left is None:
            return True
        return obj is not None and obj.type == "CURVE" and self._left.get(obj.session_uid) == digest(obj.data)

    @property
    def spots(self) -> dict[bpy.types.Object, Spot]:
        """The places of trouble by object, for the objects that still exist."""
        found = {self.session.members[spot.member].object: spot for spot in self.trouble}
        return {obj: spot for obj, spot in found.items() if obj is not None}

    @property
    def waits(self) -> bool:
        """Whether it waits for a render, during which curves must not move."""
        return not self.state.over and is_rendering()

    @property
    def endures(self) -> bool:
        """Whether it survives an undo of something else."""
        return self.state in (RunState.RUNNING, RunState.PAUSED)

    def toggle_pause(self) -> None:
        """Stop, or go on with the next iterate; during a pause the worker waits too."""
        if self.endures:
            self._show()
            self._refresh.waited = True
            self.time_left.restart()
            self.state = RunState.PAUSED if self.state is RunState.RUNNING else RunState.RUNNING
            self._worker.tell("pause", self.state is RunState.PAUSED)

    def look(self) -> None:
        """Show the shape that the scene's frame would have if the run ended here, while the timeline is used."""
        if self.last is None or self.state.over or self.waits or self.session.lost():
            return
        there = self.session.at(bpy.context.scene.frame_current_final) if self.endures and looks_back() else None
        before, self.looked_at = self.looked_at, None if there is None else there.time
        if there is not None and there.time != before:
            self.session.show(there)
            self.shown = None
        elif there is None and self.shown is None:
            self._show()

    @property
    def may_be_dragged(self) -> bool:
        """Whether a hand may pull: what is no relaxation does not heed it."""
        return self._relaxes and not self.session.goals.objects

    def grab(self, drag: Drag) -> None:
        """Take hold of a strand; `pull` and `let_go` follow."""
        self.drag, self.drags = drag, self.drags + 1
        self._worker.tell("grab", drag.component, drag.share)

    def pull(self, target: FloatArray) -> None:
        """Pull what is held to a place in view, shape (3,)."""
        if self.drag is not None and self.session.in_view is not None and np.isfinite(target).all():
            self.drag.target = target
            place = self.session.motion.size.undone(self.session.unmoved(self.drag.component, target))
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
        if self.state not in (RunState.RUNNING, RunState.PAUSED):
            return
        if self.stops and self.session.outcome is None and not reason:
            return  # what was reached is on its way
        if self.last is None and self.session.outcome is None:  # of several starts the shortest so far is kept
            self.stops, self.state = True, RunState.RUNNING
            self._worker.tell("stop")
            return
        if self.last is None:
            self.cancel(Message("Stopped before anything had moved"))
            return
        self.looked_at = self.drag = None
        self._show()
        if self.session.outcome is None:
            reason = reason or Message("stopped after {count} steps", count=self.last.index)
            self.session.outcome = Outcome(Status.INTERRUPTED, (reason,))
        self.state = RunState.FINISHING
        self._worker.close()
        thread = ThreadPoolExecutor(1, "Möbius Flow keys")
        self._keys = thread.submit(self.session.prepare, self._proved)
        thread.shutdown(wait=False)

    def _proved(self, *motion: Any) -> bool:
        """As `Session.proved`; raises MobiusFlowError if the keys are no longer wanted."""
        if self.state.over:
            raise MobiusFlowError("The relaxation is over")
        return self.session.proved(*motion)

    def cancel(self, message: str = Message("Cancelled; all is as it was")) -> None:
        if not self.state.over:
            self._close(RunState.CANCELLED, message)

    @property
    def recoverable(self) -> bool:
        """Whether it ended with the curves put back, while its iterates are still known."""
        return self.state in (RunState.CANCELLED, RunState.LOST) and self.last is not None

    def recover(self) -> None:
        """Keep what a cancelled run had reached; raises MobiusFlowError if the curves have changed since."""
        if self._keys is not None:
            wait([self._keys])  # a thread that still chooses keys ends at its next proof
        self.session.reopen()
        self.state, self.message, self.failed, self.shown = RunState.RUNNING, "", False, None
        self.trouble, self._left, self.stops = [], None, False
        self.keep()

    def tick(self) -> None:
        """Take in some iterates, or write the keys; end the run if that fails. Nothing moves while Blender renders."""
        if self.state.over or self.waits:
            return
        self.look()
        try:
            if reason := self.session.lost():
                # an object was changed from outside; the others are put back
                ended = Message("{reason}; the relaxation has ended", reason=reason)
                restored = self._close(RunState.LOST, ended)
                more = Message("and every curve is as it was" if restored else "and the others are as they were")
                if restored or len(self.session.names) > 1:
                    self.message = Message("{ended}, {more}", ended=ended, more=more)
            elif self.state is RunState.RUNNING:
                self._take()
            elif self._keys is not None and self.last is not None and self._keys.done():
                self.report = self.session.bake(self._keys.result())
                self.trouble = self.session.spots(self.report.outcome.place, self.last.curve)
                self._close(RunState.DONE, self.report.sentence, discard=False)
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
        until = time.perf_counter() + self.slice
        while self.state is RunState.RUNNING and time.perf_counter() < until:
            try:
                arrived = self._worker.poll()
            except CurveError as error:
                raise self.session.reworded(error) from error
            except WorkerError as error:
                if self.last is None:
                    raise
                self.failed = True
                self.keep(str(error))
                break
            if arrived is None:
                break
            if isinstance(arrived, Outcome):
                self.session.end(arrived)
                self.keep()
                return
            self.session.take(arrived)
            self.last = arrived
            if self._relaxes:  # ropes come to rest otherwise
                self.time_left.add(arrived)
            self.energies[arrived.index :] = [arrived.energy]
            if self._refresh.ends_batch(arrived.index):
                break
        if self.last is not None and self._refresh.due(self.last.index):
            self._show()

    def _show(self) -> None:
        if self.last is not None and self.last is not self.shown and self.looked_at is None:
            self.session.show()
            self.shown = self.last
            self._refresh.shown()

    def _fail(self, message: str, place: Place | None = None) -> None:
        self.failed = True
        self.trouble = self.session.spots(place, self.session.curve)
        self.cancel(message)

    def _close(self, state: RunState, message: str, discard: bool = True) -> bool:
        """End, putting the curves back or not; return whether all are as they were."""
        self.state, self.message, self.drag = state, message, None
        self._worker.close()
        self.on_end()
        restored = discard and self.session.discard()
        self._left = {obj.session_uid: digest(obj.data) for obj in self.session.objects}
        return restored
