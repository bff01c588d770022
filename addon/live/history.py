"""What else was done in Blender while a run goes on: undo is about that first, and about the run when all is undone."""

import bpy


class History:
    """Counts what is done from now on.

    Attributes
    ----------
    others
        Number of things that were done, such as selecting or moving an object, and not undone.
    undone
        Number of things that were undone, and may be done again.
    """

    def __init__(self) -> None:
        self.others = self.undone = 0
        self._latest = _latest()

    def look(self) -> None:
        """See whether something was done; to be called often, as Blender forgets it before it tells of an undo."""
        latest = _latest()
        if latest not in (0, self._latest):
            self.others, self.undone = self.others + 1, 0
        self._latest = latest

    def undo(self) -> None:
        """Something was undone."""
        self._change(-1)

    def redo(self) -> None:
        """Something was done again."""
        self._change(1)

    def _change(self, by: int) -> None:
        self.others, self.undone = self.others + by, self.undone - by
        self._latest = _latest()


def _latest() -> int:
    """The operation that Blender lists last in its history; the buttons of a run are not listed there."""
    done = bpy.context.window_manager.operators
    return int(done[-1].as_pointer()) if len(done) else 0
