"""The shape reached so far, shown in the curves themselves."""

from ...core import Curve
from ...core.messages import Message
from ..curves.group import Group
from ..engine.placement import Frame


class Preview:
    """What curve objects show during a run, and how that is taken back.

    Parameters
    ----------
    group
        The objects; it knows how they were.
    """

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

    def put_back(self) -> Message | None:
        """Put back for good what is left of the curves; say how much that is, if there is more to say."""
        if self._group.restore():
            return Message("and every curve is as it was")
        if len(self._group.names) > 1:
            return Message("and the others are as they were")
        return None
