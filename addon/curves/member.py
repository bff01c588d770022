"""One of the curve objects that are relaxed together: found again whatever it is called, and put back as it was."""

from typing import TYPE_CHECKING, Any

from ...core import Curve
from ..engine.placement import Frame, Placement
from . import bevel, keyframes
from .exchange import write_points
from .snapshot import Snapshot, shape

if TYPE_CHECKING:
    import bpy


class Member:
    """A curve object of a run, which touches nothing until it is told to.

    Parameters
    ----------
    obj
        A curve object that `checks.refusal` has nothing against.
    """

    def __init__(self, obj: "bpy.types.Object") -> None:
        self.name = obj.name
        self.fits_bevel = bevel.can_fit(obj.data)
        self.keyed = False  # whether keys are being written, or are written
        self._uid, self._data_uid, self._data_name = obj.session_uid, obj.data.session_uid, obj.data.name
        self._placement = Placement.from_matrix(obj.matrix_world)
        self._snapshot = Snapshot(obj.data)
        self._shape = shape(obj.data)

    @property
    def object(self) -> "bpy.types.Object | None":
        """The object, whatever its name is now; None if it is gone."""
        import bpy

        return _found(bpy.data.objects, self.name, self._uid)

    @property
    def data(self) -> "bpy.types.Curve | None":
        """The curve data, even if the object is gone."""
        import bpy

        return _found(bpy.data.curves, self._data_name, self._data_uid)

    @property
    def moved(self) -> bool:
        """Whether the object is no longer where it was."""
        obj = self.object
        return obj is not None and not Placement.from_matrix(obj.matrix_world).equals(self._placement)

    def make_polygons(self, original: Curve, refined: Curve) -> None:
        """Give the splines the points of the refined curve, unless they are lost; where points are is left open."""
        if self.lost():
            return
        try:
            self._snapshot.make_polygons(self.data, original, refined)
        finally:
            self._shape = shape(self.data)

    def show(self, points: Frame) -> None:
        """Move the points, unless they are lost; shape (n, 3), the object's coordinates."""
        if not self.lost():
            write_points(self.data, points)

    def lost(self) -> str | None:
        """Say what somebody did to the curve that makes going on impossible."""
        obj, data = self.object, self.data
        if obj is None or data is None or not obj.users_scene:
            return f"'{self.name}' was deleted"
        self.name, self._data_name = obj.name, data.name
        if obj.data != data:
            return f"'{self.name}' was given other curve data"
        if obj.mode != "OBJECT":
            return f"'{self.name}' is being edited"
        if shape(data) != self._shape:
            return f"Points of '{self.name}' were added or removed"
        return f"'{self.name}' was given shape keys" if self._foreign_keys(data) else None

    def restore(self) -> bool:
        """Put back what was there, even if the object is gone and its data is not, unless someone else changed it.

        Return whether the object is as it was.
        """
        data, obj = self.data, self.object
        if data is None or shape(data) != self._shape or self._foreign_keys(data):
            return False
        owned = obj is not None and obj.data == data
        if owned and self.keyed:
            keyframes.erase(obj)
        self._snapshot.restore(data)
        return owned

    def set_aside(self) -> None:
        """Put the splines back for a moment, unless they are lost or being keyed."""
        if not (self.keyed or self.lost()):
            self._snapshot.restore(self.data)
            self._shape = shape(self.data)

    def _foreign_keys(self, data: "bpy.types.Curve") -> bool:
        """Whether somebody gave the curve shape keys: they fit the points it has now."""
        return data.shape_keys is not None and not self.keyed


def _found(blocks: "bpy.types.bpy_prop_collection", name: str, uid: int) -> Any:
    """A datablock by its identity; it is looked up by its last name first, as there may be thousands."""
    block = blocks.get(name)
    if block is not None and block.session_uid == uid:
        return block
    return next((block for block in blocks if block.session_uid == uid), None)
