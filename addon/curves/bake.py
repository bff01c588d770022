"""What a curve that was keyed here records in a custom property: its keys, and its curve data before them."""

import hashlib
from collections.abc import Sequence
from dataclasses import replace

import bpy
import numpy as np

from ...core.base import FloatArray, Message, MobiusFlowError
from ...core.keys.key_options import Course, KeyOptions, Output, Timing
from ...core.keys.placement import Similarity
from . import keyframes
from .keyframes import animated, count_own, draw_line, fcurves_of, there_and_back
from .sizes import drive
from .splines import Splines, read, shape

_RECORD = "mobius_flow_bake"  # custom property of curve data


def remember(
    data: bpy.types.Curve,
    timing: Timing,
    frames: FloatArray,
    course: Course,
    shown: Sequence[Similarity],
    before: bpy.types.Curve | None,
    rope: float,
) -> None:
    """Record how curve data has just been keyed, the keys' sizes, and what it was before; nothing without keys.

    ``before``: None if the keys follow others, the last of which is the first of them; ``rope``: see `rope`.
    """
    if before is not None:
        if data.shape_keys is None:
            return
        slots = len(before.materials), len(data.materials)  # those between are goals'
        data[_RECORD] = {"original": before, "holds": [timing.hold_start, 0], "loop": timing.loop, "slots": slots}
        data[_RECORD]["rope"] = rope
    else:
        course = _course(data).then(course)
        frames, shown = np.append(data[_RECORD]["frames"], frames[1:]), [*_sizes(data), *shown[1:]]
        data[_RECORD]["rope"] = min(data[_RECORD].get("rope", 0.0), rope)
    record = data[_RECORD]
    record["frames"], record["course"] = frames.tolist(), np.concatenate(course).tolist()
    record["sizes"] = [float(value) for size in shown for value in (size.factor, *size.shift)]
    record["fingerprint"], record["shapes"] = _fingerprint(data), _digest(data)
    for name in ("forces", "struts"):  # are about points that were there before
        record.pop(name, None)
    # the rest before the first key of all is the one that was baked; a loop begins again at the first frame
    after = timing.hold_start - 1 if timing.loop else timing.hold_end
    record["bevel_depth"], record["holds"] = data.bevel_depth, [record["holds"][0], after]


def key_count(data: bpy.types.Curve) -> int:
    """The number of keys that curve data was given here."""
    return len(data[_RECORD].get("frames", ())) if _RECORD in data else 0


def _course(data: bpy.types.Curve) -> Course:
    return Course(*np.array(data[_RECORD]["course"]).reshape(len(Course._fields), -1))


def sizes(data: bpy.types.Curve) -> list[Similarity]:
    """How a curve is shown, in its object's coordinates, at each of its keys; one as it is where that is at all."""
    count = len(data.shape_keys.key_blocks) if data.shape_keys else 0
    noted = _sizes(data) if _RECORD in data else []
    return noted if len(noted) == count > 0 else [Similarity()] * max(count, 1)


def _sizes(data: bpy.types.Curve) -> list[Similarity]:
    noted = np.array(data[_RECORD].get("sizes", ())).reshape(-1, 4)
    return [Similarity(float(factor), shift) for factor, shift in zip(noted[:, 0], noted[:, 1:], strict=True)]


def resize(obj: bpy.types.Object, shown: Sequence[Similarity]) -> None:
    """Show a baked curve in other sizes at its shape keys."""
    obj.data[_RECORD]["sizes"] = [float(value) for size in shown for value in (size.factor, *size.shift)]
    drive(obj, shown)


def retime(data: bpy.types.Curve, timing: Timing) -> bool:
    """Let a baked curve's keys be passed at other frames; return whether they are, and nobody has moved them.

    Raises OptionError if they would not all be passed.
    """
    record = data[_RECORD]
    old, there = np.array(record["frames"]), keyframes.frames_of(data)
    if len(there) < len(old) or np.abs(there[: len(old)] - old).max() > 0.02:
        return False
    timing.check_keys(len(old))
    new = timing.frames(_course(data))
    for curve in [curve for owner in animated(data) for curve in fcurves_of(owner)]:
        points = curve.keyframe_points
        places, kinds = read(points, "co", 2).astype(np.float64), read(points, "interpolation", dtype=np.int32)
        way = places[: np.searchsorted(places[:, 0], old[-1] + 1e-3)]  # frames nearer than that are one
        draw_line(curve, *there_and_back(np.interp(way[:, 0], old, new), way[:, 1], timing), int(kinds[0]))
    record["frames"], record["loop"] = new.tolist(), timing.loop
    record["holds"] = [timing.hold_start, timing.hold_start - 1 if timing.loop else timing.hold_end]
    return True


def original(data: bpy.types.Curve) -> bpy.types.Curve:
    return data[_RECORD]["original"]


def rope(data: bpy.types.Curve) -> float:
    """Radius of the rope that a baked curve is proved to be at its last key, as stored, and with shape keys at all; 0
    if it is none, or points were moved since.
    """
    return float(data[_RECORD].get("rope", 0.0)) if is_baked(data) and not is_edited(data) else 0.0


def press(data: bpy.types.Curve, forces: FloatArray, struts: FloatArray) -> None:
    """Note where a curve, if it is baked, touches at its last key: see `contacts`."""
    if _RECORD in data:
        data[_RECORD]["forces"], data[_RECORD]["struts"] = forces.tolist(), struts.ravel().tolist()


def contacts(data: bpy.types.Curve) -> tuple[FloatArray, FloatArray]:
    """Contact forces at the points of a curve that was pulled tight, (n,), and its struts, as shown at the last key.

    A row of struts, (k, 7), has two ends and a force. There are no forces, (0,), where nothing was pulled tight.
    """
    known = data[_RECORD] if is_baked(data) and not is_edited(data) else {}
    struts = np.array(known.get("struts", ())).reshape(-1, 7)
    ends = sizes(data)[-1].of(struts[:, :6].reshape(-1, 3)).reshape(-1, 6)
    return np.array(known.get("forces", ())), np.column_stack([ends, struts[:, 6]])


def is_baked(data: bpy.types.Curve) -> bool:
    """Whether a curve has the shape keys that were written here, and no other keys or points."""
    record = data.get(_RECORD, {}) if data.shape_keys else {}
    whole = record.get("original") is not None and "course" in record  # early versions noted less
    return whole and list(record["fingerprint"]) == _fingerprint(data)


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
    if looping := next((obj.name for obj in objects if obj.data[_RECORD].get("loop")), None):
        raise MobiusFlowError(Message("'{name}' ends where it begins; switch Loop off first", name=looping))
    # the first of the new frames is the last of the old ones
    timing = replace(options.timing, start_frame=float(played[1]), length=options.timing.length + 1, loop=False)
    return replace(options, output=Output.SHAPE_KEYS, timing=timing)


def clear(obj: bpy.types.Object) -> None:
    """Remove a baked curve's keys and restore the curve that was there before.

    A bevel that was changed since the keys were written stays, and so do the materials that splines were given, but
    for those of goals.
    """
    data, record = obj.data, obj.data[_RECORD]
    before, bevel_depth, (first, last) = record["original"], record["bevel_depth"], record.get("slots", (0, 0))
    keyed = {curve.data_path for curve in (fcurves_of(data) if data in animated(data) else ())}
    slots = [spline.material_index for spline in data.splines]
    forget(obj)
    Splines.of(before).fill(data)
    for k, (spline, slot) in enumerate(zip(data.splines, slots, strict=True)):
        if f"splines[{k}].material_index" not in keyed:
            spline.material_index = slot
    used = {spline.material_index for spline in data.splines}
    for slot in reversed(range(first, min(last, len(data.materials)))):
        if slot not in used:
            data.materials.pop(index=slot)
    if data.bevel_depth == bevel_depth:
        for name in ("bevel_depth", "bevel_resolution", "use_fill_caps"):
            setattr(data, name, getattr(before, name))
    if not before.users:
        bpy.data.curves.remove(before)


def forget(obj: bpy.types.Object) -> None:
    """Remove a curve's keys, and its record if it was baked; the curve itself keeps the shape of its last key."""
    keyframes.erase(obj)
    obj.data.pop(_RECORD, None)


def _fingerprint(data: bpy.types.Curve) -> list[int]:
    """Counts of shape keys, F-curves and points, and which splines are open; -1 for animation that is not ours."""
    keys, moved, splines = data.shape_keys, data.animation_data, shape(data)
    driven = keys.animation_data.drivers if keys.animation_data is not None else ()
    other = any(driver.data_path.startswith(("eval_time", "key_blocks")) for driver in driven)  # which move points
    other = other or bool(moved and (moved.nla_tracks or (moved.action and count_own(data) is None)))
    own = None if other else count_own(keys)
    blocks = -1 if keys.use_relative else len(keys.key_blocks)
    open_ones = [k for k, (*_, closed) in enumerate(splines) if not closed]
    return [blocks, -1 if own is None else own, sum(count for count, *_ in splines), *open_ones]


def _digest(data: bpy.types.Curve) -> str:
    """A fingerprint of the positions of the points at all shape keys."""
    hashed = hashlib.blake2b(digest_size=16)
    for block in data.shape_keys.key_blocks if data.shape_keys else ():
        hashed.update(read(block.data, "co", 3).tobytes())
    return hashed.hexdigest()
