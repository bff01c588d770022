"""Whether anything else was done in Blender while a run goes on: then undo is about that, and not about the run."""

import bpy


class History:
    """What was done last when this was made, or when `catch_up` was called."""

    def __init__(self) -> None:
        self._latest = _latest()

    @property
    def others(self) -> bool:
        """Whether something was done since, such as selecting or moving an object."""
        return _latest() != self._latest

    def catch_up(self) -> None:
        """What was done up to now does not count any more."""
        self._latest = _latest()


def _latest() -> int:
    """The operation that Blender lists last in its history; the buttons of a run are not listed there."""
    done = bpy.context.window_manager.operators
    return done[-1].as_pointer() if len(done) else 0
