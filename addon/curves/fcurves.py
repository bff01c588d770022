"""Actions and their F-curves, which since Blender 4.4 are kept in layers, for one or more slots."""

from collections.abc import Iterable, Iterator
from typing import Any

import bpy
import numpy as np

from ...core.base.types import FloatArray

CONSTANT, LINEAR = 0, 1  # among the interpolations of a keyframe, as arrays of them are written in one call


def new_action(name: str, id_type: str, slot: str) -> bpy.types.Action:
    """Make an action for datablocks of a type; ``slot``: the name of its only slot, if it has slots."""
    action = bpy.data.actions.new(name)
    if hasattr(action, "slots"):  # not in Blender 4.3 and before
        strip = action.layers.new("Layer").strips.new(type="KEYFRAME")
        strip.channelbag(action.slots.new(id_type=id_type, name=slot), ensure=True)
    else:
        action.id_root = id_type
    return action


def collections(action: bpy.types.Action, slots: Iterable["bpy.types.ActionSlot"] | None = None) -> Iterator[Any]:
    """Yield the collections of F-curves of an action, or only those of some of its slots, if it has slots."""
    if not hasattr(action, "slots"):
        yield action.fcurves
        return
    for strip in (strip for layer in action.layers for strip in layer.strips):
        yield from (bag.fcurves for slot in slots or action.slots if (bag := strip.channelbag(slot)))


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
