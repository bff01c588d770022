"""Actions and their F-curves: since Blender 4.4 these are kept in layers, for one or more slots; nothing else knows."""

from collections.abc import Iterable, Iterator
from typing import Any

import bpy
import numpy as np

from ...core.base.types import FloatArray

CONSTANT, LINEAR = 0, 1  # among the interpolations of a keyframe, as arrays of them are written in one call


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


def draw_line(curve: bpy.types.FCurve, frames: FloatArray, values: FloatArray, kind: int = LINEAR) -> None:
    """Let an F-curve, or the one of a driver, be piecewise linear, or constant, with keys at these frames alone."""
    for modifier in list(curve.modifiers):  # which a driver in Blender 4.2 has instead of keys
        curve.modifiers.remove(modifier)
    points = curve.keyframe_points
    points.clear()
    points.add(len(frames))
    points.foreach_set("co", np.column_stack([frames, values]).astype(np.float32).ravel())
    points.foreach_set("interpolation", np.full(len(frames), kind, dtype=np.int32))
    curve.update()
