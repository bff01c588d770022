"""What moves an object: places of curves that are relaxed together must stay."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from ...core.messages import Message
from .fcurves import fcurves_of

if TYPE_CHECKING:
    import bpy

_TRANSFORMS = ("location", "rotation", "scale", "delta_", "matrix", "parent")


def what_moves(obj: "bpy.types.Object") -> Message | None:
    """Say what may move an object or one of its parents by itself, or return None if nothing does."""
    return next(_movers(obj), None)


def _movers(obj: "bpy.types.Object") -> Iterator[Message]:
    animation = obj.animation_data
    if animation and animation.nla_tracks:
        yield Message("an NLA track")
    if animation and animation.action and _transforms(fcurves_of(obj)):
        yield Message("animation")
    if animation and _transforms(animation.drivers):
        yield Message("a driver")
    if any(not constraint.mute for constraint in obj.constraints):
        yield Message("a constraint")
    if obj.rigid_body and obj.rigid_body.type == "ACTIVE":  # a passive one is hit, and stays where it is
        yield Message("physics")
    if obj.parent:
        yield from _parental(obj)


def _parental(obj: "bpy.types.Object") -> Iterator[Message]:
    """A parent carries an object along when it moves, and some do when they change their shape or pose."""
    if obj.parent_type != "OBJECT" or (obj.parent.type == "CURVE" and obj.parent.data.use_path):
        yield Message("its parent")
    for reason in _movers(obj.parent):
        yield Message("{mover} of its parent", mover=reason) if reason != "its parent" else reason


def _transforms(curves: "Iterator[bpy.types.FCurve]") -> bool:
    return any(curve.data_path.startswith(_TRANSFORMS) for curve in curves)
