"""What a curve that was keyed here remembers, in a custom property: the keys, and the curve data that it was before."""

import hashlib
from collections.abc import Sequence
from dataclasses import replace

import bpy
import numpy as np

from ...core import MobiusFlowError
from ...core.messages import Message
from ..engine.key_options import KeyOptions, Output, Timing
from . import blends, keyframes
from .exchange import key_points
from .keyframes import animated, count_own
from .splines import Splines, shape

_RECORD = "mobius_flow_bake"  # custom property of curve data
_DRIVEN = ("splines", "eval_time", "key_blocks")  # beginnings of paths of drivers that move points
_BEVEL = ("bevel_depth", "bevel_resolution", "use_fill_caps")


def remember(data: bpy.types.Curve, before: bpy.types.Curve, timing: Timing) -> None:
    """Note on curve data that has just been keyed how it was before; nothing is noted on data without keys."""
    if animated(data):
        data[_RECORD] = {"original": before, "holds": [timing.hold_start, 0], "loop": timing.loop}
        update(data, timing)


def original(data: bpy.types.Curve) -> bpy.types.Curve:
    return data[_RECORD]["original"]


def update(data: bpy.types.Curve, timing: Timing | None = None) -> None:
    """Note how the keys are after they were changed here, or, with a timing, more of them were written."""
    record = data[_RECORD]
    record["fingerprint"], record["shapes"] = _fingerprint(data), _digest(data)
    if timing is not None:  # the rest before the first key of all is the one that was baked
        # the frame where a loop begins again is the first one
        after = timing.hold_start - 1 if timing.loop else timing.hold_end
        record["bevel_depth"], record["holds"] = data.bevel_depth, [record["holds"][0], after]


def scale_bevel(data: bpy.types.Curve, factor: float) -> None:
    """Scale the bevel; if it is the one that was baked, it still counts as such."""
    record, ours = data[_RECORD], data.bevel_depth == data[_RECORD]["bevel_depth"]
    data.bevel_depth *= factor
    if ours:
        record["bevel_depth"] = data.bevel_depth


def loops(data: bpy.types.Curve) -> bool:
    """Whether a baked curve goes back to where it began."""
    return bool(data[_RECORD].get("loop", False))


def is_baked(data: bpy.types.Curve) -> bool:
    """Whether a curve has the keys that were written here, and neither others nor other points."""
    record = data.get(_RECORD)
    return record is not None and record["original"] is not None and list(record["fingerprint"]) == _fingerprint(data)


def was_baked(data: bpy.types.Curve) -> bool:
    """Whether a curve was baked, whatever has become of its keys and points since."""
    return _RECORD in data


def is_edited(data: bpy.types.Curve) -> bool:
    """Whether somebody has moved points of a baked curve's shape keys: a look at all of them, not for every redraw."""
    return bool(data[_RECORD]["shapes"] != _digest(data))


def scene_range(objects: Sequence[bpy.types.Object]) -> tuple[int, int] | None:
    """First and last frame of baked objects' animations with their rests, wherever keys have been moved to."""
    firsts, lasts = [], []
    for data in [obj.data for obj in objects if is_baked(obj.data)]:
        first, last = animated(data)[0].animation_data.action.curve_frame_range
        before, after = data[_RECORD]["holds"]
        firsts.append(int(np.floor(first - before)))
        lasts.append(int(np.ceil(last + after)))
    return (min(firsts), max(lasts)) if firsts else None


def continued(objects: Sequence[bpy.types.Object], options: KeyOptions) -> KeyOptions:
    """The options that let an animation go on where the last of some baked objects comes to rest."""
    played = scene_range(objects)
    assert played is not None, "they are baked"
    if looping := next((obj.name for obj in objects if loops(obj.data)), None):
        raise MobiusFlowError(
            Message("'{name}' ends where it begins; switch Loop off, and Relax it anew", name=looping)
        )
    # the first of the new frames is the last of the old ones
    timing = replace(options.timing, start_frame=float(played[1]), length=options.timing.length + 1, loop=False)
    return replace(options, output=Output.SHAPE_KEYS if not options.animated else options.output, timing=timing)


def clear(obj: bpy.types.Object) -> None:
    """Take a baked curve's keys away and give the curve back that was there before.

    A bevel that was changed since the keys were written stays, and so do the materials that splines were given.
    """
    data = obj.data
    before, bevel_depth = original(data), data[_RECORD]["bevel_depth"]
    slots = [spline.material_index for spline in data.splines]
    forget(obj)
    Splines.of(before).fill(data)
    for spline, slot in zip(data.splines, slots, strict=True):
        spline.material_index = slot
    blends.take_off(data)
    if data.bevel_depth == bevel_depth:
        for name in _BEVEL:
            setattr(data, name, getattr(before, name))
    if not before.users:
        bpy.data.curves.remove(before)


def forget(obj: bpy.types.Object) -> None:
    """Take a curve's keys away, and what is remembered if it was baked; the curve itself is left as its last key."""
    keyframes.erase(obj)
    obj.data.pop(_RECORD, None)


def _fingerprint(data: bpy.types.Curve) -> list[int]:
    """Numbers of keys, of F-curves and of points, and which splines are open; -1 where somebody else's animation is."""
    keys = data.shape_keys
    owner, moved = keys or data, data.animation_data
    blocks = 0 if keys is None else -1 if keys.use_relative else len(keys.key_blocks)
    other = keys is not None and moved is not None and bool(moved.action or moved.nla_tracks)
    driven = owner.animation_data.drivers if owner.animation_data is not None else ()
    other = other or any(driver.data_path.startswith(_DRIVEN) for driver in driven)
    own = None if other else count_own(owner)
    splines = shape(data)
    points, open_ones = sum(each.count for each in splines), [k for k, each in enumerate(splines) if not each.closed]
    return [blocks, -1 if own is None else own, points, *open_ones]


def _digest(data: bpy.types.Curve) -> str:
    """A name for where the points are at all shape keys."""
    hashed = hashlib.blake2b(digest_size=16)
    for block in data.shape_keys.key_blocks if data.shape_keys else ():
        hashed.update(key_points(block).tobytes())
    return hashed.hexdigest()
