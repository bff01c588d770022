"""The current or last run, and what else has been done in Blender since it began: kept in Python, never in the file."""

from typing import TYPE_CHECKING

import bpy

from ..translations import iface_

if TYPE_CHECKING:
    from .run import LiveRun

_latest: "list[LiveRun]" = []


class ActionCount:
    """Counts other actions during a run, such as selecting or moving an object: undo takes these back before the run.

    ``others`` were done and not undone, ``undone`` may be redone. Drags share one undo step among them, made anew after
    each undo: Blender's own undo then takes back the last drag.
    """

    def __init__(self) -> None:
        self.others = self.undone = self._seen = self._step = 0

    def begin(self) -> None:
        self.others = self.undone = self._step = 0
        self._seen = _last_operation()

    def push(self, run: "LiveRun") -> None:
        """Make an undo step if there are drags; the originals are in the file for that moment."""
        if run.drags and not self._step and run.endures:
            run.session.hide()
            bpy.ops.ed.undo_push(message=iface_("Drag"))
            run.session.resume()
            self.others, self.undone, self._seen = self.others + 1, 0, _last_operation()
            self._step = self.others

    def look(self) -> None:
        """Notice a new action; to be called often, since Blender's list has lost it by the time undo is announced."""
        last = _last_operation()
        if last not in (0, self._seen):
            self.others, self.undone = self.others + 1, 0
        self._seen = last

    def undo(self, count: int = 1) -> bool:
        """Note that an action was undone, or redone if ``count`` is -1; return whether it was the drags' step."""
        self.others, self.undone = self.others - count, self.undone + count
        self._seen = _last_operation()
        if drag := self._step > self.others:
            self._step = 0
        return drag


def _last_operation() -> int:
    """The last operation in Blender's list, where the buttons of a run do not appear."""
    done = bpy.context.window_manager.operators
    return int(done[-1].as_pointer()) if len(done) else 0


history = ActionCount()


def begin(run: "LiveRun") -> None:
    """Make a run the current one; there is only one at a time."""
    assert current() is None, "`requirements.idle` says so before"
    _latest[:] = [run]
    history.begin()


def current() -> "LiveRun | None":
    """The run in progress, if there is one."""
    run = latest()
    return None if run is None or run.state.over else run


def latest() -> "LiveRun | None":
    """The run in progress, or else the last one."""
    return _latest[0] if _latest else None


def shown(obj: bpy.types.Object | None) -> "LiveRun | None":
    """The run in progress, or else the last one if an object is still as the run left it."""
    run = latest()
    return run if run is not None and run.concerns(obj) else None


def forget() -> None:
    _latest.clear()
