"""Motion written into curve data: absolute shape keys, and one F-curve that runs through them.

Data that already has such keys gets the new ones after the last.  Since Blender 4.4 actions keep F-curves in layers,
for one or more slots; nothing else knows.
"""

from collections.abc import Iterable, Iterator
from typing import Any

import bpy
import numpy as np

from ...core.base import FloatArray
from ...core.keys.key_options import Timing
from ...core.keys.placement import Frame
from ...core.keys.recording import Keys
from .splines import radii as spline_radii
from .splines import read

CONSTANT, LINEAR = 0, 1  # among the interpolations of a keyframe, as arrays of them are written in one call
ONCE = Timing()
_MARK = "mobius_flow"  # custom property of the actions made here


def write(
    obj: bpy.types.Object, keys: Keys, frames: FloatArray, radii: FloatArray | None = None, timing: Timing = ONCE
) -> None:
    """Write keys to a curve object with as many points, which are those of the last key.

    It has no animation, or keys of an earlier call, the last of which is the first of the new ones. ``frames``: scene
    frame of each key, ascending; ``radii``: factors of the points' own radii at each key, (keys,), or for each point,
    (keys, n); ``timing``: whether keys are passed again on the way back.
    """
    data = obj.data
    own = np.concatenate([spline_radii(spline) for spline in data.splines])
    there = len(data.shape_keys.key_blocks) if data.shape_keys else 0
    skipped = min(there, 1)  # the first of the additional keys is there already
    for k, key in enumerate(keys.keys[skipped:], skipped):
        place = there - skipped + k
        if place:
            # An absolute key is put where the evaluation time is. In steps of 1 it is read back exactly; Blender's
            # own steps of 10 add up rounding errors, and the animation would miss its keys.
            data.shape_keys.use_relative = False
            data.shape_keys.eval_time = place
        block = obj.shape_key_add(name=f"{key.kind.value} {key.time:g}", from_mix=False)
        block.interpolation = "KEY_LINEAR"
        block.data.foreach_set("co", key.points.ravel())
        if radii is not None:
            block.data.foreach_set("radius", (own * radii[k]).astype(np.float32))
    data.shape_keys.use_relative = False
    data.shape_keys.eval_time = 0
    values = there - skipped + np.arange(float(len(frames)))
    add_keys(data.shape_keys, f"{obj.name} Relaxation", "eval_time", 0, *there_and_back(frames, values, timing))


def erase(obj: bpy.types.Object) -> None:
    """Remove all that `write` has written except the positions of the points.

    Actions and slots that nothing else uses are deleted.
    """
    for animation in [owner.animation_data for owner in animated(obj.data)]:
        action, slot = animation.action, getattr(animation, "action_slot", None)
        animation.action = None
        if action.users == action.use_fake_user:
            bpy.data.actions.remove(action)
        elif slot is not None and not slot.users():
            action.slots.remove(slot)
    if obj.data.shape_keys:
        uid = obj.data.shape_keys.session_uid
        obj.shape_key_clear()
        # Blender 5.0 counts one user too many where curve data was copied, and leaves the keys behind
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


def blocks(data: bpy.types.Curve) -> dict[str, bpy.types.ID]:
    """Curve data, its shape keys, and their action or its own."""
    owner = data.shape_keys or data
    action = owner.animation_data.action if owner.animation_data else None
    found = {"curve": data, "keys": data.shape_keys, "action": action}
    return {kind: block for kind, block in found.items() if block is not None}


def keyed_points(data: bpy.types.Curve) -> list[Frame]:
    """Points of a curve at each of its keys, (n, 3)."""
    return [read(block.data, "co", 3) for block in data.shape_keys.key_blocks]


def there_and_back(frames: FloatArray, values: FloatArray, timing: Timing) -> tuple[FloatArray, FloatArray]:
    """Frames and values of all keys of an F-curve, those passed on the way back included."""
    back = timing.way_back(frames)
    return np.concatenate([frames, back]), np.concatenate([values, values[::-1][len(values) - len(back) :]])


def frames_of(data: bpy.types.Curve) -> FloatArray:
    """The frames at which the keys of curve data are passed, on the way back too, (k,)."""
    curve = fcurves_of(data.shape_keys)[0]
    return read(curve.keyframe_points, "co", 2)[:, 0].astype(np.float64)


def fcurves_of(block: bpy.types.ID) -> Any:
    """The F-curves of a datablock that has an action: those of its own slot.

    Since 4.4 Blender puts keys of an object into the action of its curve, if that has one, and the other way round.
    """
    return own_fcurves(block.animation_data)


def count_own(block: bpy.types.ID) -> int | None:
    """Number of F-curves of a datablock if it is animated by an action made here and by nothing else, or None."""
    animation = block.animation_data
    if animation is None or animation.action is None or animation.nla_tracks or _MARK not in animation.action:
        return None
    return len(own_fcurves(animation))


def animated(data: bpy.types.Curve) -> list[bpy.types.ID]:
    """The datablocks that have actions: shape keys first, and the curve itself."""
    owners = [owner for owner in (data.shape_keys, data) if owner is not None]
    return [owner for owner in owners if owner.animation_data is not None and owner.animation_data.action is not None]


def add_keys(
    block: bpy.types.ID, name: str, path: str, axis: int, frames: FloatArray, values: FloatArray, kind: int = LINEAR
) -> None:
    """Add keys to an F-curve of a datablock's action; keys not after its last one are left out.

    What is not there is made: the F-curve, and an action of this name.
    """
    if not (block.animation_data and block.animation_data.action):
        new_action(name, block.id_type, block.name, block.animation_data_create())[_MARK] = True
    fcurves = fcurves_of(block)
    curve = fcurves.find(path, index=axis) or fcurves.new(path, index=axis)
    later = frames > curve.keyframe_points[-1].co[0] if len(curve.keyframe_points) else slice(None)
    _append(curve, frames[later], values[later], kind)


def draw_line(curve: bpy.types.FCurve, frames: FloatArray, values: FloatArray, kind: int = LINEAR) -> None:
    """Let an F-curve, or the one of a driver, be piecewise linear, or constant, with keys at these frames alone."""
    for modifier in list(curve.modifiers):  # which a driver in Blender 4.2 has instead of keys
        curve.modifiers.remove(modifier)
    curve.keyframe_points.clear()
    _append(curve, frames, values, kind)


def _append(curve: bpy.types.FCurve, frames: FloatArray, values: FloatArray, kind: int) -> None:
    points, first = curve.keyframe_points, len(curve.keyframe_points)
    points.add(len(frames))
    places, kinds = read(points, "co", 2), read(points, "interpolation", dtype=np.int32)
    places[first:], kinds[first:] = np.column_stack([frames, values]), kind
    points.foreach_set("co", places.ravel())
    points.foreach_set("interpolation", kinds)
    curve.update()


def new_action(name: str, id_type: str, slot: str, user: Any) -> bpy.types.Action:
    """Make an action with a slot, of a name, for datablocks of a type, and give both to an animation or constraint."""
    action = bpy.data.actions.new(name)
    if not hasattr(action, "slots"):
        action.id_root = id_type
        user.action = action
        return action
    strip, slots = action.layers.new("Layer").strips.new(type="KEYFRAME"), action.slots
    strip.channelbag(slots.new(id_type=id_type, name=slot), ensure=True)
    user.action, user.action_slot = action, slots[0]
    return action


def _collections(action: bpy.types.Action, slots: Iterable[Any]) -> list[Any]:
    """The collections of F-curves of an action, for some of its slots, if it has slots."""
    if not hasattr(action, "slots"):
        return [action.fcurves]
    strips = [strip for layer in action.layers for strip in layer.strips]
    return [bag.fcurves for strip in strips for slot in slots if (bag := strip.channelbag(slot))]


def all_fcurves() -> Iterator[bpy.types.FCurve]:
    """Yield the F-curves of all actions in the file."""
    for action in bpy.data.actions:
        for fcurves in _collections(action, getattr(action, "slots", ())):
            yield from fcurves


def own_fcurves(user: Any) -> Any:
    """The F-curves of an animation or a constraint that has an action: those of its slot."""
    slot = getattr(user, "action_slot", None)
    found = _collections(user.action, [slot] if slot else [])
    return found[0] if found else ()


def copy_action(user: Any) -> None:
    """Give an animation that shares its action, such as that of a copy, an action of its own."""
    slot = getattr(user, "action_slot", None)
    handle = slot and slot.identifier
    user.action = action = user.action.copy()
    for other in [each for each in action.slots if each.identifier != handle] if handle else ():
        action.slots.remove(other)
    if handle:
        user.action_slot = action.slots[0]
