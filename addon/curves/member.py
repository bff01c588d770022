"""One of the curve objects that are relaxed together: found again whatever it is called, and put back as it was."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from ...core import Curve
from ...core.messages import Message
from ...core.types import FloatArray
from ..engine.key_options import KeyOptions
from ..engine.motion import Keys
from ..engine.placement import Frame, Placement
from . import bake, bevel, keyframes
from .deforming import what_deforms
from .exchange import write_points
from .snapshot import Snapshot, shape
from .stand_in import StandIn, found

if TYPE_CHECKING:
    import bpy


class Member:
    """A curve object of a run; nothing of it is touched until that is asked for, but a baked curve is set aside.

    Parameters
    ----------
    obj
        A curve object that `checks.refusal` has nothing against.
    continues
        Whether a baked curve is relaxed on from the end of its animation, and not from how it was before.
    """

    def __init__(self, obj: "bpy.types.Object", continues: bool = False) -> None:
        self.name = obj.name
        self.keyed = False  # whether keys are being written, or are written
        self._stand_in = StandIn(obj, continues) if bake.is_baked(obj.data) else None
        self._plain, self._fitted = bevel.can_fit(obj.data), bevel.is_fitted(obj.data)
        self._uid = obj.session_uid
        self._placement = Placement.from_matrix(obj.matrix_world)
        self._snapshot = Snapshot.of(obj.data)
        self._identify(obj.data)

    def _identify(self, data: "bpy.types.Curve") -> None:
        self._data_uid, self._data_name, self._shape = data.session_uid, data.name, shape(data)
        self._shapes = [self._shape]  # those that it has had in this run

    @property
    def object(self) -> "bpy.types.Object | None":
        """The object, whatever its name is now; None if it is gone."""
        import bpy

        return found(bpy.data.objects, self.name, self._uid)

    @property
    def data(self) -> "bpy.types.Curve | None":
        """The curve data, even if the object is gone."""
        import bpy

        return found(bpy.data.curves, self._data_name, self._data_uid)

    @property
    def rebakes(self) -> bool:
        """Whether a baked curve is set aside."""
        return self._stand_in is not None

    @property
    def moved(self) -> bool:
        """Whether the object is no longer where it was."""
        obj = self.object
        return obj is not None and not Placement.from_matrix(obj.matrix_world).equals(self._placement)

    def fits(self, options: KeyOptions) -> bool:
        """Whether the tube is to be fitted: it was before, or somebody asks for it."""
        return self._plain and options.fit_bevel and (self._fitted or options.any_bevel)

    def make_polygons(self, original: Curve, refined: Curve) -> None:
        """Give the splines the points of the refined curve, unless they are lost; where points are is left open."""
        if self.lost():
            return
        try:
            self._snapshot.make_polygons(self.data, original, refined)
        finally:
            self._shape = shape(self.data)
            self._shapes.append(self._shape)

    def show(self, points: Frame) -> None:
        """Move the points, unless they are lost; shape (n, 3), the object's coordinates."""
        if not self.lost():
            write_points(self.data, points)

    def lost(self) -> Message | None:
        """Say what somebody did to the curve that makes going on impossible."""
        obj, data = self.object, self.data
        if obj is None or data is None or not obj.users_scene:
            return Message("'{name}' was deleted", name=self.name)
        self.name, self._data_name = obj.name, data.name
        if obj.data != data:
            return Message("'{name}' was given other curve data", name=self.name)
        if obj.mode != "OBJECT":
            return Message("'{name}' is being edited", name=self.name)
        if shape(data) != self._shape:
            counts = [each.count for each in shape(data)] != [each.count for each in self._shape]
            changed = "Points of '{name}' were added or removed" if counts else "Splines of '{name}' were changed"
            return Message(changed, name=self.name)
        if self._foreign_keys(data):
            return Message("'{name}' was given shape keys", name=self.name)
        deformer = what_deforms(obj)
        return Message("{deformer} moves its points", deformer=deformer) if deformer else None

    def writing(self, keys: Keys, frames: FloatArray, options: KeyOptions, radii: FloatArray | None) -> Iterator[None]:
        """Write keys in short pieces; ``radii`` are those of the tube in the object's units, (keys,)."""
        obj = self.object
        assert obj is not None, "whoever writes looks for it first"
        self.keyed = True
        if self._stand_in is not None:
            self._stand_in.take_keys(obj)
            self._identify(obj.data)
        relative = None
        if radii is not None and self.fits(options):
            depth = obj.data.bevel_depth
            bevel.fit(obj.data, float(radii[-1]))
            keyframes.scale_radii(obj.data, depth / obj.data.bevel_depth)
            relative = radii / radii[-1]
        yield from keyframes.writing(obj, keys, frames, keyframes.output_of(obj.data) or options.output, relative)

    def settle(self, options: KeyOptions) -> None:
        """Make what was written final: nothing can be put back after this."""
        data = self.data
        assert data is not None, "it was written a moment ago"
        if self._stand_in is not None:
            self._stand_in.replace(data)
        if self._stand_in is not None and self._stand_in.continues:
            bake.update(data, options.timing)
        else:
            bake.remember(data, self._snapshot, options.timing)

    def restore(self) -> bool:
        """Put back what was there, even if the object is gone and its data is not, unless someone else changed it.

        Return whether the object is as it was.
        """
        data, obj = self.data, self.object
        if data is None or shape(data) != self._shape or self._foreign_keys(data):
            return False
        owned = obj is not None and obj.data == data
        if self._stand_in is not None:
            self._stand_in.put_back(obj if owned else None, data)
            return owned
        if owned and self.keyed:
            keyframes.erase(obj)
        self._snapshot.restore(data)
        return owned

    def set_aside(self) -> None:
        """Put the curve back for a moment, unless it is lost or being keyed."""
        if self.keyed or self.lost():
            return
        if self._stand_in is not None:
            self._stand_in.step_aside(self.object)
        else:
            self._snapshot.restore(self.data)
            self._shape = shape(self.data)

    def put_forward(self) -> None:
        """Go on after `set_aside`, and after undo since then; where the points are is left open."""
        obj, data = self.object, self.data
        if obj is None or data is None:
            return
        if self._stand_in is not None and obj.data == self._stand_in.baked:
            self._stand_in.step_forward(obj, data)
        if shape(data) in self._shapes:
            self._shape = shape(data)

    def _foreign_keys(self, data: "bpy.types.Curve") -> bool:
        """Whether somebody gave the curve shape keys: they fit the points it has now."""
        return data.shape_keys is not None and not self.keyed
