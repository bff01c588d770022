"""What moves an object: places of curves that are relaxed together must stay."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from ..engine.phrase import Phrase
from .fcurves import fcurves_of

if TYPE_CHECKING:
    import bpy

_TRANSFORMS = ("location", "rotation", "scale", "delta_", "matrix", "parent")


def what_moves(obj: "bpy.types.Object") -> Phrase | None:
    """Say what may move an object or one of its parents by itself, or return None if nothing does."""
    return next(_movers(obj), None)


def _movers(obj: "bpy.types.Object") -> Iterator[Phrase]:
    animation = obj.animation_data
    if animation and animation.nla_tracks:
        yield Phrase("an NLA track")
    if animation and animation.action and _transforms(fcurves_of(obj)):
        yield Phrase("animation")
    if animation and _transforms(animation.drivers):
        yield Phrase("a driver")
    if any(not constraint.mute for constraint in obj.constraints):
        yield Phrase("a constraint")
    if obj.rigid_body and obj.rigid_body.type == "ACTIVE":  # a passive one is hit, and stays where it is
        yield Phrase("physics")
    if obj.parent:
        yield from _parental(obj)


def _parental(obj: "bpy.types.Object") -> Iterator[Phrase]:
    """A parent carries an object along when it moves, and some do when they change their shape or pose."""
    if obj.parent_type != "OBJECT" or (obj.parent.type == "CURVE" and obj.parent.data.use_path):
        yield Phrase("its parent")
    for reason in _movers(obj.parent):
        yield Phrase("{mover} of its parent", mover=reason) if reason != "its parent" else reason


def _transforms(curves: "Iterator[bpy.types.FCurve]") -> bool:
    return any(curve.data_path.startswith(_TRANSFORMS) for curve in curves)
