"""Motion written into curve data: absolute shape keys with one F-curve, or an F-curve for every coordinate.

Data that has such keys already gets more of them after the last.
"""

from collections.abc import Iterator

import bpy
import numpy as np

from ...core.types import FloatArray
from ..engine.key_options import Output, Timing
from ..engine.motion import Keys
from ..engine.placement import Frame
from .exchange import key_points, key_radii, write_points
from .fcurves import FCurves, drop_actions, fcurves_of

_ONCE = Timing()


def writing(
    obj: bpy.types.Object,
    keys: Keys,
    frames: FloatArray,
    output: Output,
    radii: FloatArray | None = None,
    timing: Timing = _ONCE,
) -> Iterator[None]:
    """Write keys in short pieces to a curve object with as many points; the curve itself keeps the last key.

    It has no animation, or keys of an earlier call, the last of which is the first of the new ones. ``frames``: scene
    frame of each key, ascending; ``radii``: relative radii at each, (keys,) or of each point, (keys, n); None keeps the
    points' own; ``timing``: whether keys are passed again on the way back.
    """
    write_points(obj.data, keys.keys[-1].points)
    if output is Output.SHAPE_KEYS:
        yield from _shape_keys(obj, keys, frames, radii, timing)
    elif output is Output.FCURVES:
        yield from _fcurves(obj, keys, frames)


def erase(obj: bpy.types.Object) -> None:
    """Remove all that `writing` has written but where the points are."""
    drop_actions(obj.data)
    if obj.data.shape_keys:
        uid = obj.data.shape_keys.session_uid
        obj.shape_key_clear()
        # Blender 5.0 counts a user too many where curve data was copied, and leaves the keys behind
        bpy.data.batch_remove([keys for keys in bpy.data.shape_keys if keys.session_uid == uid])
    animation = obj.data.animation_data
    if animation and not (animation.drivers or animation.nla_tracks):
        obj.data.animation_data_clear()


def remove(data: bpy.types.Curve) -> None:
    """Remove curve data that no object has any more, with its keys and the actions that nothing else uses."""
    bare = bpy.data.objects.new(data.name, data)  # Blender removes keys for objects only
    erase(bare)
    bpy.data.objects.remove(bare)
    bpy.data.curves.remove(data)


def names(data: bpy.types.Curve) -> dict[str, str]:
    """The names of curve data, of its shape keys, and of their action or its own."""
    return {kind: block.name for kind, block in _blocks(data).items()}


def rename(data: bpy.types.Curve, wanted: dict[str, str]) -> None:
    """Give curve data and its keys names that are free now."""
    for kind, block in _blocks(data).items():
        block.name = wanted.get(kind, block.name)


def _blocks(data: bpy.types.Curve) -> dict[str, bpy.types.ID]:
    owner = data.shape_keys or data
    action = owner.animation_data.action if owner.animation_data else None
    blocks = {"curve": data, "keys": data.shape_keys, "action": action}
    return {kind: block for kind, block in blocks.items() if block is not None}


def output_of(data: bpy.types.Curve) -> Output | None:
    """How the keys that curve data already has are written, or None if it has none."""
    if data.shape_keys:
        return Output.SHAPE_KEYS
    return Output.FCURVES if data.animation_data and data.animation_data.action else None


def end_of(data: bpy.types.Curve) -> Frame:
    """Points of a curve at the last of its keys, (n, 3); what is stored may be another frame's."""
    if data.shape_keys:
        return key_points(data.shape_keys.key_blocks[-1])
    last = [curve.keyframe_points[-1].co[1] for curve in coordinate_curves(data)]
    return np.array(last, dtype=np.float32).reshape(-1, 3)


def scale_radii(data: bpy.types.Curve, factors: float | FloatArray) -> None:
    """Multiply the points' radii at all shape keys by one factor, or one for each, (keys,)."""
    blocks = data.shape_keys.key_blocks if data.shape_keys else ()
    for block, factor in zip(blocks, np.broadcast_to(factors, len(blocks)), strict=True):
        block.data.foreach_set("radius", key_radii(block) * np.float32(factor))


def _shape_keys(
    obj: bpy.types.Object, keys: Keys, frames: FloatArray, radii: FloatArray | None = None, timing: Timing = _ONCE
) -> Iterator[None]:
    """Absolute shape keys, and an F-curve that runs through them."""
    data = obj.data
    there = len(data.shape_keys.key_blocks) if data.shape_keys else 0
    skipped = min(there, 1)  # the first of more keys is there already
    for k, key in enumerate(keys.keys[skipped:], skipped):
        place = there - skipped + k
        if place:
            # An absolute key is put where the evaluation time is. In steps of 1 it is read back exactly; Blender's own
            # steps of 10 add up rounding errors, and the animation would pass beside its keys.
            data.shape_keys.use_relative = False
            data.shape_keys.eval_time = place
        block = obj.shape_key_add(name=f"Iterate {key.time:g}", from_mix=False)
        block.interpolation = "KEY_LINEAR"
        block.data.foreach_set("co", key.points.ravel())
        if radii is not None:
            block.data.foreach_set("radius", np.broadcast_to(radii[k], len(key.points)).astype(np.float32))
        yield
    data.shape_keys.use_relative = False
    data.shape_keys.eval_time = 0
    curves = FCurves(data.shape_keys, f"{obj.name} Relaxation")
    places, back = there - skipped + np.arange(len(frames), dtype=np.float64), timing.way_back(frames)
    values = np.concatenate([places, places[::-1][len(places) - len(back) :]])
    curves.add("eval_time", 0, np.concatenate([frames, back]), values)


def _fcurves(obj: bpy.types.Object, keys: Keys, frames: FloatArray) -> Iterator[None]:
    """One F-curve for every coordinate of every point, for exporters that know no shape keys."""
    curves = FCurves(obj.data, f"{obj.name} Relaxation")
    values = np.stack([key.points for key in keys.keys], axis=-1).astype(np.float64)
    for path, point in zip(point_paths(obj.data), values, strict=True):
        for axis in range(3):
            curves.add(path, axis, frames, point[axis])
        yield


def point_paths(data: bpy.types.Curve) -> Iterator[str]:
    """Where the coordinates of each point are found."""
    for s, spline in enumerate(data.splines):
        yield from (f"splines[{s}].points[{p}].co" for p in range(len(spline.points)))


def coordinate_curves(data: bpy.types.Curve) -> list[bpy.types.FCurve]:
    """The F-curves of all coordinates of a curve that is keyed by them, point by point."""
    found = {(curve.data_path, curve.array_index): curve for curve in fcurves_of(data)}
    return [found[path, axis] for path in point_paths(data) for axis in range(3)]
