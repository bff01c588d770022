"""F-curves and their actions, in all versions of Blender."""

from collections.abc import Iterable, Iterator
from itertools import chain
from typing import Any

import bpy
import numpy as np

from ...core.types import FloatArray

_LINEAR = 1  # 'LINEAR' among the interpolations of a keyframe, as arrays of them are written in one call
_MARK = "mobius_flow"  # custom property of the actions made here


def all_fcurves() -> Iterator[bpy.types.FCurve]:
    """Yield the F-curves of all actions in the file."""
    for action in bpy.data.actions:
        slotted = hasattr(action, "slots")  # not in Blender 4.3 and before
        yield from chain.from_iterable(_collections(action, action.slots) if slotted else [action.fcurves])


def fcurves_of(block: bpy.types.ID) -> Iterator[bpy.types.FCurve]:
    """The F-curves of a datablock that has an action: those of its own slot.

    Since 4.4 Blender puts keys of an object into the action of its curve, if that has one, and the other way round.
    """
    return chain.from_iterable(_own_collections(block))


def count_own(block: bpy.types.ID) -> int | None:
    """Number of F-curves of a datablock if it is animated by an action made here and by nothing else, or None."""
    animation = block.animation_data
    if animation is None or animation.action is None or animation.nla_tracks or _MARK not in animation.action:
        return None
    return sum(len(fcurves) for fcurves in _own_collections(block))


def own_action(block: bpy.types.ID) -> None:
    """Give a datablock that shares its action with others, such as the one it was copied from, an action of its own."""
    animation = block.animation_data
    slot = animation.action_slot.identifier if hasattr(animation.action, "slots") else None
    animation.action = action = animation.action.copy()
    if slot is not None:
        for other in [each for each in action.slots if each.identifier != slot]:
            action.slots.remove(other)
        animation.action_slot = action.slots[0]


def animated(data: bpy.types.Curve) -> list[bpy.types.ID]:
    """The datablocks that have actions: shape keys first, and the curve itself."""
    owners = [owner for owner in (data.shape_keys, data) if owner is not None]
    return [owner for owner in owners if owner.animation_data is not None and owner.animation_data.action is not None]


def drop_actions(data: bpy.types.Curve) -> None:
    """Take the actions of a curve and its shape keys away, and remove what nothing else uses of them."""
    for animation in [owner.animation_data for owner in animated(data)]:
        action, slot = animation.action, getattr(animation, "action_slot", None)
        animation.action = None
        if action.users == action.use_fake_user:
            bpy.data.actions.remove(action)
        elif slot is not None and not slot.users():
            action.slots.remove(slot)


def _collections(action: bpy.types.Action, slots: Iterable[bpy.types.ActionSlot]) -> Iterator[Any]:
    for layer in action.layers:
        for strip in layer.strips:
            channels = (strip.channelbag(slot) for slot in slots)
            yield from (each.fcurves for each in channels if each)


def _own_collections(block: bpy.types.ID) -> Iterator[Any]:
    animation = block.animation_data
    if not hasattr(animation.action, "slots"):  # Blender 4.3 and before
        yield animation.action.fcurves
    elif animation.action_slot:
        yield from _collections(animation.action, [animation.action_slot])


def mirror(curve: bpy.types.FCurve, middle: float) -> None:
    """Let an F-curve that runs straight go back from a frame on as it came."""
    for frame, value in [tuple(point.co) for point in curve.keyframe_points][::-1]:
        if frame < middle:
            curve.keyframe_points.insert(2 * middle - frame, value, options={"FAST"}).interpolation = "LINEAR"
    curve.update()


class FCurves:
    """The F-curves of the action on a datablock, which gets a new one if it has none."""

    def __init__(self, block: bpy.types.ID, name: str) -> None:
        if not (block.animation_data and block.animation_data.action):
            animation = block.animation_data_create()
            animation.action = action = bpy.data.actions.new(name)
            action[_MARK] = True
            if hasattr(action, "slots"):  # not in Blender 4.3 and before
                animation.action_slot = slot = action.slots.new(id_type=block.id_type, name=block.name)
                strip = action.layers.new("Layer").strips.new(type="KEYFRAME")
                strip.channelbag(slot, ensure=True)
        (self._fcurves,) = _own_collections(block)

    def add(self, path: str, axis: int, frames: FloatArray, values: FloatArray) -> None:
        """Add keys to a piecewise linear F-curve, made if there is none; what is not after its last is left out."""
        curve = self._fcurves.find(path, index=axis) or self._fcurves.new(path, index=axis)
        points = curve.keyframe_points
        if len(points):
            later = frames > points[-1].co[0]
            frames, values = frames[later], values[later]
        first = len(points)
        points.add(len(frames))
        places = np.empty((len(points), 2), dtype=np.float32)
        kinds = np.empty(len(points), dtype=np.int32)
        points.foreach_get("co", places.ravel())
        points.foreach_get("interpolation", kinds)
        places[first:], kinds[first:] = np.column_stack([frames, values]), _LINEAR
        points.foreach_set("co", places.ravel())
        points.foreach_set("interpolation", kinds)
        curve.update()
