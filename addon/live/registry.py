"""Which run is going on or was the last, and what else has been done in Blender meanwhile: known to Python only."""

from typing import TYPE_CHECKING

import bpy

if TYPE_CHECKING:
    from .run import Run

_latest: "list[Run]" = []


class History:
    """Counts what is done in Blender during a run: undo is about that first, and about the run when all is undone.

    ``others`` were done, such as selecting or moving an object, and not undone; ``undone`` may be done again.
    """

    def __init__(self) -> None:
        self.others = self.undone = self._seen = 0

    def begin(self) -> None:
        """Count from now on."""
        self.others = self.undone = 0
        self._seen = _last_operation()

    def look(self) -> None:
        """See whether something was done; to be called often, as Blender forgets it before it tells of an undo."""
        last = _last_operation()
        if last not in (0, self._seen):
            self.others, self.undone = self.others + 1, 0
        self._seen = last

    def undo(self, count: int = 1) -> None:
        """Take note that something was undone, or with -1 done again."""
        self.others, self.undone = self.others - count, self.undone + count
        self._seen = _last_operation()


def _last_operation() -> int:
    """The operation that Blender lists last in its history; the buttons of a run are not listed there."""
    done = bpy.context.window_manager.operators
    return int(done[-1].as_pointer()) if len(done) else 0


history = History()


def begin(run: "Run") -> None:
    """A run goes on from now; there is only one at a time."""
    assert current() is None, "`requirements.idle` says so before"
    _latest[:] = [run]
    history.begin()


def current() -> "Run | None":
    """The run that is going on, if there is one."""
    run = latest()
    return None if run is None or run.state.over else run


def latest() -> "Run | None":
    """The run that is going on, or else the last one."""
    return _latest[0] if _latest else None


def shown(obj: bpy.types.Object | None) -> "Run | None":
    """The run that is going on, or else the last one, if what is known of it is about an object as it is now."""
    run = latest()
    return run if run is not None and run.concerns(obj) else None


def forget() -> None:
    _latest.clear()
