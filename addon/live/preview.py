"""The shape reached so far, shown in the curves themselves, and how often it is: the computation comes first."""

import time
from collections.abc import Callable

from ...core import Curve
from ..curves.group import Group
from ..engine.phrase import Phrase
from ..engine.placement import Frame

_REST = 2.0  # times as long as drawing takes nothing is drawn after it: drawing gets a third of the time


class Preview:
    """What the objects of a group, which knows how they were, show during a run, and how that is taken back."""

    def __init__(self, group: Group) -> None:
        self._group = group
        self._start: Curve | None = None
        self._frame: Frame | None = None

    def show(self, start: Curve, frame: Frame) -> None:
        """Move all points to an iterate, whose vertices are stored as ``frame``; ``start`` is the start on its mesh."""
        if self._start is None or self._start.mesh != start.mesh:
            self._group.make_polygons(start)
            self._start = start
        self._frame = frame
        self._group.show(start.mesh, frame)

    def set_aside(self) -> None:
        """Put the curves back for a moment, because the file is being saved."""
        self._group.set_aside()

    def put_forward(self) -> None:
        """Show the iterate again after `set_aside`."""
        self._group.put_forward()
        if self._start is not None and self._frame is not None:
            self._group.make_polygons(self._start)
            self._group.show(self._start.mesh, self._frame)

    def put_back(self) -> Phrase | None:
        """Put back for good what is left of the curves; say how much that is, if there is more to say."""
        if self._group.restore():
            return Phrase("and every curve is as it was")
        if len(self._group.names) > 1:
            return Phrase("and the others are as they were")
        return None


class Refresh:
    """Decides which iterates are shown.

    Parameters
    ----------
    every
        Show every so many iterates; 0: as often as leaves two thirds of the time to anything but drawing.
    clock
        Seconds that pass.
    """

    def __init__(self, every: int = 0, clock: Callable[[], float] = time.perf_counter) -> None:
        self._every, self._clock = every, clock
        self._shown: float | None = None
        self._next = clock()

    def shown(self) -> None:
        """Note that an iterate is being shown; Blender draws it before it sends the next event."""
        self._shown = self._clock()

    def drawn(self) -> None:
        """Note that an event has come: what was shown last has been drawn."""
        if self._shown is not None:
            now = self._clock()
            self._next = now + _REST * (now - self._shown)
            self._shown = None

    def ends_batch(self, index: int) -> bool:
        """Whether an iterate must be shown before the next one is taken in."""
        return self._every > 0 and index % self._every == 0

    def due(self, index: int) -> bool:
        """Whether an iterate, the last one taken in, is to be shown now."""
        return self.ends_batch(index) if self._every else self._clock() >= self._next
