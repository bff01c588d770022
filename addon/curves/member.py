"""One of the curve objects that are relaxed together: during a run it shows a stand-in for its curve data.

The original is not touched until all is written, its keys included: to end a run without a result is to show it again.
The stand-in refers to it in a custom property, so that it is neither purged nor missing in an undo step or an automatic
save. When such a file is opened, or undo returns to such a step, `show_originals` shows it again.
"""

import bpy
import numpy as np

from ...core import Curve
from ...core.base import FloatArray, Message
from ...core.keys.key_options import Course, KeyOptions
from ...core.keys.placement import Frame
from ...core.keys.recording import Keys
from . import bake, bevel, doors, keyframes, sizes
from .moving import what_deforms
from .sizes import placement
from .splines import SOURCE, Reference, Splines, read, shape, write_points

_MARK = "mobius_flow_stand_in"  # custom property of stand-ins


class Member:
    """A curve object of a run, as for `Session`; nothing of it is touched before `begin`."""

    def __init__(self, obj: bpy.types.Object, continues: bool = False) -> None:
        self.name = obj.name
        self._continues, self._baked = continues, bake.is_baked(obj.data)
        self._object, self._original = Reference(obj), Reference(obj.data)
        self._stand_in: Reference | None = None
        self._keyed = False  # whether keys were being written when something failed
        mark = obj.data.get(SOURCE)
        self.drawn = mark["object"].name if mark and mark["object"] else obj.name  # what somebody has drawn
        self._source = Reference(mark["object"]) if mark and mark["object"] and not self._baked else None

    def begin(self) -> None:
        """Show a stand-in: the curve that the relaxation begins with."""
        obj, original = self.found(), self._original.get()
        assert obj is not None, "whoever begins looks for it first"
        sizes.suspend(obj)
        self.placement = placement(obj)
        self.size = self.placement.in_world(bake.sizes(original)[-1])
        self.replaced = 0 if self._continues or not self._baked else bake.key_count(original)
        self._show(original.copy())
        if self._baked and self._continues:
            bake.forget(obj)
            write_points(obj.data, keyframes.keyed_points(original)[-1])
        elif self._baked:
            bake.clear(obj)
        self._shape = shape(obj.data)
        self._splines = Splines.of(obj.data)
        carries = SOURCE in obj.data and not self._continues
        self._strands = doors.strands_of(obj) if carries else None
        self._plain, self._fitted = bevel.can_fit(obj.data), bevel.is_fitted(obj.data)

    def _show(self, data: bpy.types.Curve) -> None:
        original = self._original.get()
        data[_MARK] = {"original": original, "name": data.name}  # copies have the mark too, but another name
        self._stand_in, self._shape = Reference(data), shape(data)
        self._object.get().data = data

    def found(self) -> bpy.types.Object | None:
        """The object, or a new carrier of its source where undo, saving or the end of a run has taken that away."""
        source = self._source.get() if self._source is not None else None
        if self.object is None and source is not None:
            obj = doors.enter(source)
            self._object, self._original = Reference(obj), Reference(obj.data)
        return self.object

    @property
    def object(self) -> bpy.types.Object | None:
        """The object, whatever its name is now; None if it is gone."""
        return self._object.get()

    @property
    def data(self) -> bpy.types.Curve | None:
        """The stand-in, even if the object is gone."""
        return self._stand_in.get() if self._stand_in else None

    def fits(self, options: KeyOptions) -> bool:
        """Whether the tube is to be fitted: it was before, or somebody asks for it."""
        return self._plain and options.fit_bevel and (self._fitted or options.any_bevel)

    def make_polygons(self, drawn: Curve, refined: Curve) -> None:
        """Give the stand-in the points of the refined curve, unless it is lost; their positions are left open."""
        if not self.lost():
            self._splines.polygons(drawn, refined).fill(self.data)
            self._shape = shape(self.data)
            if self._strands is not None:
                here = refined.with_vertices(self.placement.to_local(refined.vertices))
                doors.follow(self._object.get(), self._strands, drawn, here)

    def move(self, points: Frame, radius: float | None) -> None:
        """Move the points, (n, 3), unless they are lost, and give the tube the radius, in the object's coordinates."""
        if not self.lost():
            write_points(self.data, points)
            if radius is not None:
                bevel.draw(self.data, radius)

    def lost(self) -> Message | None:
        """Say what was done to the curve that makes it impossible to go on."""
        obj, data = self.object, self.data
        if obj is None or not obj.users_scene:
            return Message("'{name}' was deleted", name=self.name)
        self.name = obj.name
        if data is None or obj.data != data:
            return Message("'{name}' was given other curve data", name=self.name)
        if obj.mode != "OBJECT":
            return Message("'{name}' is being edited", name=self.name)
        if shape(data) != self._shape:
            counts = [count for count, *_ in shape(data)] != [count for count, *_ in self._shape]
            changed = "Points of '{name}' were added or removed" if counts else "Splines of '{name}' were changed"
            return Message(changed, name=self.name)
        if data.shape_keys is not None:  # they fit the points it has now
            return Message("'{name}' was given shape keys", name=self.name)
        deformer = what_deforms(obj)
        return Message("{deformer} moves its points", deformer=deformer) if deformer else None

    def write(self, keys: Keys, frames: FloatArray, options: KeyOptions, radii: FloatArray | None) -> None:
        """Write keys; ``radii``: of the tube in the object's units, (keys,)."""
        obj = self.object
        assert obj is not None, "whoever writes looks for it first"
        self._keyed = True
        if self._baked and self._continues:  # show a copy of the original with its keys, to be added to
            preview = self.data
            _name_original(preview)
            data = self._original.get().copy()
            keyframes.copy_action(data.shape_keys.animation_data)
            self._show(data)
            keyframes.remove(preview)
        relative = np.array([1.0 / key.size.factor for key in keys.keys])  # what is drawn is not to be scaled
        if radii is not None and self.fits(options):
            depth = obj.data.bevel_depth
            bevel.fit(obj.data, float(radii[-1]), options.constant_radius)
            for block in obj.data.shape_keys.key_blocks if obj.data.shape_keys else ():  # radii are relative to it
                block.data.foreach_set("radius", read(block.data, "radius") * np.float32(depth / obj.data.bevel_depth))
            relative = radii / radii[-1]
        write_points(obj.data, keys.keys[-1].points)
        if options.animated:
            keyframes.write(obj, keys, frames, relative, options.timing)

    def keep(self, keys: Keys, frames: FloatArray, options: KeyOptions, course: Course, rope: float) -> None:
        """Make what was written final: the stand-in takes over the names and the users of the original.

        What was relaxed is kept by the record of the bake; without one, only undo brings it back.  ``rope``: the
        radius of the rope that is seen, as stored, in the object's units; 0 if there is none.
        """
        data, original = self.data, self._original.get()
        assert data is not None, "it was written a moment ago"
        _name_original(data)
        start = bake.original(original) if self._baked else original
        names = {kind: block.name for kind, block in keyframes.blocks(original).items()}
        original.name = f"{original.name} Original"
        del data[_MARK]
        original.use_fake_user, data.use_fake_user = False, original.use_fake_user
        original.user_remap(data)
        sizes_here = [self.placement.similarity(key.size) for key in keys.keys]
        follows = self._baked and self._continues
        bake.remember(data, options.timing, frames, course, sizes_here, None if follows else start, rope)
        if not original.users:
            keyframes.remove(original)
        for kind, block in keyframes.blocks(data).items():  # names that are free now
            block.name = names.get(kind, block.name)
        doors.keep(self.object)
        sizes.drive(self.object, bake.sizes(data))

    def discard(self) -> bool:
        """Show the original again, and remove the stand-in unless someone else changed it.

        Return whether the object is as it was.
        """
        obj, data, original = self.object, self.data, self._original.get()
        if data is not None and (shape(data) != self._shape or (data.shape_keys is not None and not self._keyed)):
            del data[_MARK]
            original.use_fake_user = True  # whoever changed it may want that too
            if self._fitted:
                bevel.fit(data, data.bevel_depth)
            return False
        restored = obj is not None and obj.data in (data, original)
        if data is not None:
            _show_original(data)
        elif restored:
            doors.withdraw(obj)
        if obj is None and self._source is not None:
            doors.leave(original)
        return restored

    def hide(self) -> None:
        """Show the original for a moment, because the file is being saved or something is undone."""
        if not self.lost():
            _name_original(self.data)
            obj, data = self._object.get(), self.data
            obj.data = self._original.get()
            sizes.resume(obj)
            doors.withdraw(obj)
            if self.object is None:
                keyframes.remove(data)

    def resume(self) -> None:
        """Show the stand-in again after `hide`; undo may have removed it, or brought another one back."""
        original, data = self._original.get(), self.data
        for other in _stand_ins():
            if other != data and other[_MARK]["original"] == original:
                _show_original(other)
        obj = self.object
        if obj is None and self._source is not None and self._source.get() is not None:
            self.begin()
        if obj is None or obj.data not in (original, data):
            return
        if data is None:
            self.begin()
        else:
            sizes.suspend(obj)
            self._show(data)


def show_originals() -> None:
    """Show all originals that are hidden by stand-ins in the file, when no run is going on."""
    for data in _stand_ins():
        if not data.is_editmode:
            _show_original(data)


def _stand_ins() -> list[bpy.types.Curve]:
    return [data for data in bpy.data.curves if _MARK in data and data[_MARK]["name"] == data.name]


def _show_original(data: bpy.types.Curve) -> None:
    """Give the original the users of its stand-in, which is removed."""
    _name_original(data)
    original = data.pop(_MARK)["original"]
    if original is not None:
        wearers = [obj for obj in bpy.data.objects if obj.data == data]
        data.user_remap(original)
        keyframes.remove(data)
        for obj in wearers:
            sizes.resume(obj)
            doors.withdraw(obj)


def _name_original(data: bpy.types.Curve) -> None:
    """Give the original the name that somebody gave its stand-in."""
    mark, given = data[_MARK], data.name
    if given != mark["name"] and mark["original"] is not None:
        data.name = mark["name"]
        mark["original"].name = given
        mark["name"] = data.name
