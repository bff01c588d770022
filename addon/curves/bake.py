"""What a curve that was keyed here records in a custom property: its keys, and its curve data before them."""

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
    """Record on curve data that has just been keyed what it was before; data without keys gets no record."""
    if animated(data):
        data[_RECORD] = {"original": before, "holds": [timing.hold_start, 0], "loop": timing.loop}
        update(data, timing)


def original(data: bpy.types.Curve) -> bpy.types.Curve:
    return data[_RECORD]["original"]


def update(data: bpy.types.Curve, timing: Timing | None = None) -> None:
    """Record how the keys are after a change made here or, with a timing, after more keys were written."""
    record = data[_RECORD]
    record["fingerprint"], record["shapes"] = _fingerprint(data), _digest(data)
    if timing is not None:  # the rest before the first key of all is the one that was baked
        # the frame where a loop begins again is the first one
        after = timing.hold_start - 1 if timing.loop else timing.hold_end
        record["bevel_depth"], record["holds"] = data.bevel_depth, [record["holds"][0], after]


def scale_bevel(data: bpy.types.Curve, factor: float) -> None:
    """Scale the bevel; if it is the baked one, it still counts as baked."""
    record, ours = data[_RECORD], data.bevel_depth == data[_RECORD]["bevel_depth"]
    data.bevel_depth *= factor
    if ours:
        record["bevel_depth"] = data.bevel_depth


def loops(data: bpy.types.Curve) -> bool:
    """Whether a baked curve goes back to where it began."""
    return bool(data[_RECORD].get("loop", False))


def is_baked(data: bpy.types.Curve) -> bool:
    """Whether a curve has the keys that were written here, and no other keys or points."""
    record = data.get(_RECORD)
    return record is not None and record["original"] is not None and list(record["fingerprint"]) == _fingerprint(data)


def was_baked(data: bpy.types.Curve) -> bool:
    """Whether a curve was baked, whatever has become of its keys and points since."""
    return _RECORD in data


def is_edited(data: bpy.types.Curve) -> bool:
    """Whether somebody has moved points of a baked curve's shape keys: examines them all, so not for every redraw."""
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
    """The options with which an animation continues where the last of some baked objects comes to rest."""
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
    """Remove a baked curve's keys and restore the curve that was there before.

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
    """Remove a curve's keys, and its record if it was baked; the curve itself keeps the shape of its last key."""
    keyframes.erase(obj)
    obj.data.pop(_RECORD, None)


def _fingerprint(data: bpy.types.Curve) -> list[int]:
    """Counts of keys, F-curves and points, and which splines are open; -1 for animation that is not ours."""
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
    """A fingerprint of the positions of the points at all shape keys."""
    hashed = hashlib.blake2b(digest_size=16)
    for block in data.shape_keys.key_blocks if data.shape_keys else ():
        hashed.update(key_points(block).tobytes())
    return hashed.hexdigest()
