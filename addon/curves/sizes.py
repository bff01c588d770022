"""The sizes in which baked curve objects are shown: a constraint scales and moves them as their shape keys are passed.

It applies an action in the object's own coordinates, so that the object can be moved, turned, scaled and parented at
any time, and works where there is no extension. A driver lets it follow the evaluation time: keys may be at any frames.
"""

from collections.abc import Sequence

import bpy
import numpy as np

from ...core.keys.placement import Placement, Similarity
from .keyframes import draw_line, new_action, own_fcurves

_NAME = "Keep Size"
_MARK = "mobius_flow_sizes"  # custom property of the actions made here


def drive(obj: bpy.types.Object, sizes: Sequence[Similarity]) -> None:
    """Let an object be shown in a size, in its own coordinates, at each of its shape keys, and in no other one."""
    release(obj)
    if all(size.is_identity for size in sizes):
        return
    keeper = obj.constraints.new("ACTION")
    keeper.name = _NAME
    new_action(_NAME, "OBJECT", _NAME, keeper)[_MARK] = True
    fcurves = own_fcurves(keeper)
    places = np.arange(float(len(sizes)))
    for axis in range(3):
        draw_line(fcurves.new("location", index=axis), places, np.array([size.shift[axis] for size in sizes]))
        draw_line(fcurves.new("scale", index=axis), places, np.array([size.factor for size in sizes]))
    keeper.mix_mode, keeper.use_eval_time = "AFTER_FULL", True
    keeper.frame_start, keeper.frame_end = 0, len(sizes) - 1
    curve = keeper.driver_add("eval_time")
    curve.driver.type = "AVERAGE"
    for old in list(curve.driver.variables):  # Blender 4.2 keeps the driver of a constraint that somebody removes
        curve.driver.variables.remove(old)
    target = curve.driver.variables.new().targets[0]
    target.id_type, target.id, target.data_path = "KEY", obj.data.shape_keys, "eval_time"
    draw_line(curve, places[[0, -1]], np.array([0.0, 1.0]))
    bpy.context.view_layer.update()


def is_own(constraint: bpy.types.Constraint) -> bool:
    """Whether a constraint is one of those made here, whatever its name is now."""
    return constraint.type == "ACTION" and constraint.action is not None and _MARK in constraint.action


def release(obj: bpy.types.Object) -> None:
    """Let an object be as large as its curve."""
    for keeper in filter(is_own, list(obj.constraints)):
        action = keeper.action
        keeper.driver_remove("eval_time")
        obj.constraints.remove(keeper)
        if not action.users:  # by copies of the object
            bpy.data.actions.remove(action)
        animation = obj.animation_data
        if animation and not (animation.action or animation.drivers or animation.nla_tracks):
            obj.animation_data_clear()
        bpy.context.view_layer.update()


def suspend(obj: bpy.types.Object) -> None:
    """Let an object be as large as its curve until `resume`."""
    for keeper in filter(is_own, obj.constraints):
        keeper.influence = 0.0  # whether it is muted is up to the artist
        bpy.context.view_layer.update()


def resume(obj: bpy.types.Object) -> None:
    for keeper in filter(is_own, obj.constraints):
        keeper.influence = 1.0


def placement(obj: bpy.types.Object) -> Placement:
    """Where an object's curve is in the world, as large as it is, whatever the constraint makes of it."""
    shown = Placement.from_matrix(obj.matrix_world)
    for keeper in filter(is_own, obj.constraints):
        if keeper.influence and not keeper.mute:
            fcurves = own_fcurves(keeper)
            place = keeper.eval_time * keeper.frame_end
            shift = np.array([fcurves.find("location", index=axis).evaluate(place) for axis in range(3)])
            linear = shown.linear / fcurves.find("scale", index=0).evaluate(place)
            shown = Placement(linear, shown.origin - linear @ shift)
    return shown
