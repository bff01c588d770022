"""F-curves and their actions, in all versions of Blender."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.types import FloatArray

if TYPE_CHECKING:
    import bpy

_LINEAR = 1  # 'LINEAR' among the interpolations of a keyframe, as arrays of them are written in one call
_MARK = "mobius_flow"  # custom property of the actions made here


def all_fcurves() -> Iterator["bpy.types.FCurve"]:
    """Yield the F-curves of all actions in the file."""
    import bpy

    for action in bpy.data.actions:
        yield from fcurves_of(action)


def fcurves_of(action: "bpy.types.Action") -> Iterator["bpy.types.FCurve"]:
    """Yield the F-curves of an action."""
    for fcurves in _collections(action):
        yield from fcurves


def count_own(block: "bpy.types.ID") -> int | None:
    """Number of F-curves of a datablock if it is animated by an action made here and by nothing else, or None."""
    animation = block.animation_data
    if animation is None or animation.action is None or animation.nla_tracks or _MARK not in animation.action:
        return None
    return sum(len(fcurves) for fcurves in _collections(animation.action))


def own_action(block: "bpy.types.ID") -> None:
    """Give a datablock that shares its action with the one it was copied from an action of its own."""
    animation = block.animation_data
    animation.action = animation.action.copy()
    if hasattr(animation.action, "slots"):
        animation.action_slot = animation.action.slots[0]


def drop_actions(data: "bpy.types.Curve") -> None:
    """Take the actions of a curve and its shape keys away, and remove those that nothing else uses."""
    import bpy

    for owner in (data.shape_keys, data):
        action = owner.animation_data.action if owner and owner.animation_data else None
        if action is not None:
            owner.animation_data.action = None
            if action.users == action.use_fake_user:
                bpy.data.actions.remove(action)


def _collections(action: "bpy.types.Action") -> Iterator[Any]:
    if not hasattr(action, "slots"):  # Blender 4.3 and before
        yield action.fcurves
        return
    for layer in action.layers:
        for strip in layer.strips:
            for channels in strip.channelbags:
                yield channels.fcurves


class FCurves:
    """The F-curves of the action on a datablock, which gets a new one if it has none.

    Parameters
    ----------
    block
        The datablock.
    name
        What a new action is called.
    """

    def __init__(self, block: "bpy.types.ID", name: str) -> None:
        if not (block.animation_data and block.animation_data.action):
            _make_action(block, name)
        (self._fcurves,) = _collections(block.animation_data.action)

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


def _make_action(block: "bpy.types.ID", name: str) -> None:
    import bpy

    animation = block.animation_data_create()
    action = bpy.data.actions.new(name)
    action[_MARK] = True
    animation.action = action
    if not hasattr(action, "slots"):  # Blender 4.3 and before
        return
    slot = action.slots.new(id_type=block.id_type, name=block.name)
    animation.action_slot = slot
    strip = action.layers.new("Layer").strips.new(type="KEYFRAME")
    strip.channelbag(slot, ensure=True)
