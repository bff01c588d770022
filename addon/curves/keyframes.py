"""Motion written into curve data: absolute shape keys with one F-curve, or an F-curve for every coordinate."""

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.types import FloatArray
from ..engine.key_options import KeyOptions, Output
from ..engine.motion import Keys
from .exchange import write_points

if TYPE_CHECKING:
    import bpy

_LINEAR = 1  # 'LINEAR' among the interpolations of a keyframe, as arrays of them are written in one call


def write(obj: "bpy.types.Object", keys: Keys, options: KeyOptions) -> None:
    """Write keys to a curve object that has as many points as they have vertices, and neither keys nor animation."""
    for _ in writing(obj, keys, options):
        pass


def writing(
    obj: "bpy.types.Object", keys: Keys, options: KeyOptions, radii: FloatArray | None = None
) -> Iterator[None]:
    """Do as `write` does in short pieces; ``radii`` are the relative radii of the tube at the keys."""
    yield from _WRITERS[options.output](obj, keys, options.scene_frames(keys), radii)


def erase(obj: "bpy.types.Object") -> None:
    """Remove what an unfinished `writing` has left: there were neither shape keys nor an action before."""
    import bpy

    owners = [owner for owner in (obj.data.shape_keys, obj.data) if owner and owner.animation_data]
    actions = [owner.animation_data.action for owner in owners if owner.animation_data.action]
    obj.shape_key_clear()
    for action in actions:
        bpy.data.actions.remove(action)
    animation = obj.data.animation_data
    if animation and not (animation.drivers or animation.nla_tracks):
        obj.data.animation_data_clear()


def write_shape_keys(obj: "bpy.types.Object", keys: Keys, frames: FloatArray, radii: FloatArray | None = None) -> None:
    """Write keys as absolute shape keys and an F-curve that runs through them.

    The curve itself keeps the last key, so that removing the shape keys leaves the relaxed curve.

    Parameters
    ----------
    obj
        A curve object without shape keys, with as many points as the keys have vertices.
    keys
        What to write.
    frames
        Scene frame of each key, ascending.
    radii
        Radius of all points at each key; None keeps what the points have.
    """
    for _ in _shape_keys(obj, keys, frames, radii):
        pass


def _shape_keys(
    obj: "bpy.types.Object", keys: Keys, frames: FloatArray, radii: FloatArray | None = None
) -> Iterator[None]:
    data = obj.data
    write_points(data, keys.keys[-1].points)
    for k, key in enumerate(keys.keys):
        if k == 1:
            data.shape_keys.use_relative = False
        if k:
            # An absolute key is put where the evaluation time is. In steps of 1 it is read back exactly; Blender's own
            # steps of 10 add up rounding errors, and the animation would pass beside its keys.
            data.shape_keys.eval_time = k
        block = obj.shape_key_add(name=f"Iterate {key.time:g}", from_mix=False)
        block.interpolation = "KEY_LINEAR"
        block.data.foreach_set("co", key.points.ravel())
        if radii is not None:
            block.data.foreach_set("radius", np.full(len(key.points), radii[k], dtype=np.float32))
        yield
    data.shape_keys.use_relative = False
    data.shape_keys.eval_time = 0
    curves = FCurves(data.shape_keys, f"{obj.name} Relaxation")
    curves.add("eval_time", 0, frames, np.arange(len(frames), dtype=np.float64))


def _fcurves(
    obj: "bpy.types.Object", keys: Keys, frames: FloatArray, _radii: FloatArray | None = None
) -> Iterator[None]:
    """One F-curve for every coordinate of every point, for exporters that know no shape keys."""
    write_points(obj.data, keys.keys[-1].points)
    curves = FCurves(obj.data, f"{obj.name} Relaxation")
    values = np.stack([key.points for key in keys.keys], axis=-1).astype(np.float64)
    sizes = [len(spline.points) for spline in obj.data.splines]
    paths = [f"splines[{s}].points[{p}].co" for s, size in enumerate(sizes) for p in range(size)]
    for path, point in zip(paths, values, strict=True):
        for axis in range(3):
            curves.add(path, axis, frames, point[axis])
        yield


def _result(
    obj: "bpy.types.Object", keys: Keys, _frames: FloatArray, _radii: FloatArray | None = None
) -> Iterator[None]:
    """The last key alone, without animation."""
    write_points(obj.data, keys.keys[-1].points)
    yield


_Writer = Callable[["bpy.types.Object", Keys, FloatArray, FloatArray | None], Iterator[None]]
_WRITERS: dict[Output, _Writer] = {
    Output.SHAPE_KEYS: _shape_keys,
    Output.FCURVES: _fcurves,
    Output.RESULT: _result,
}


def all_fcurves() -> Iterator["bpy.types.FCurve"]:
    """Yield the F-curves of all actions in the file."""
    import bpy

    for action in bpy.data.actions:
        yield from fcurves_of(action)


def fcurves_of(action: "bpy.types.Action") -> Iterator["bpy.types.FCurve"]:
    """Yield the F-curves of an action, in all versions of Blender."""
    if not hasattr(action, "slots"):  # Blender 4.3 and before
        yield from action.fcurves
        return
    for layer in action.layers:
        for strip in layer.strips:
            for channels in strip.channelbags:
                yield from channels.fcurves


class FCurves:
    """The F-curves of a new action on a datablock, in all versions of Blender."""

    def __init__(self, block: "bpy.types.ID", name: str) -> None:
        import bpy

        animation = block.animation_data_create()
        action = bpy.data.actions.new(name)
        animation.action = action
        if not hasattr(action, "slots"):  # Blender 4.3 and before
            self._fcurves: Any = action.fcurves
            return
        slot = action.slots.new(id_type=block.id_type, name=block.name)
        animation.action_slot = slot
        strip = action.layers.new("Layer").strips.new(type="KEYFRAME")
        self._fcurves = strip.channelbag(slot, ensure=True).fcurves

    def add(self, path: str, axis: int, frames: FloatArray, values: FloatArray) -> None:
        """Add a piecewise linear F-curve."""
        curve = self._fcurves.new(path, index=axis)
        points = curve.keyframe_points
        points.add(len(frames))
        points.foreach_set("co", np.column_stack([frames, values]).astype(np.float32).ravel())
        points.foreach_set("interpolation", np.full(len(frames), _LINEAR, dtype=np.int32))
        curve.update()
