"""What changes an object with time: what is avoided must stand still, as must curves that avoid it."""

from collections.abc import Iterable, Iterator, Sequence
from itertools import chain
from typing import TYPE_CHECKING

from ...core.messages import Message
from .deforming import nodes_of
from .fcurves import fcurves_of
from .ingredients import ingredients, metaballs
from .moving import what_moves

if TYPE_CHECKING:
    import bpy

_CHANGING = {
    "BUILD",
    "CLOTH",
    "DYNAMIC_PAINT",
    "EXPLODE",
    "FLUID",
    "MESH_CACHE",
    "MESH_SEQUENCE_CACHE",
    "OCEAN",
    "PARTICLE_INSTANCE",
    "SOFT_BODY",
    "WAVE",
}
_SHAPING = ("modifiers", "pose")  # beginnings of paths of F-curves of an object
_CHANGING_NODES = {"GeometryNodeInputSceneTime", "GeometryNodeSimulationInput"}


def unsteady(avoided: Iterable["bpy.types.Object"], relaxed: Sequence["bpy.types.Object"]) -> Message | None:
    """Say what of objects that are avoided, or of curves that avoid them, does not stay as it is, or return None."""
    avoided = list(avoided)
    moving = next((said for obj in avoided if (said := unsteady_object(obj, relaxed))), None)
    return moving or (next((said for obj in relaxed if (said := _unsteady_curve(obj))), None) if avoided else None)


def unsteady_object(obj: "bpy.types.Object", relaxed: Sequence["bpy.types.Object"]) -> Message | None:
    """Say why an object cannot be avoided, since it does not stand still, or return None if it does."""
    mover = what_changes(obj, relaxed)
    sentence = (
        "'{name}' is moved by {mover}, and what is avoided must stand still; "
        "remove that, or leave it out of what is avoided"
    )
    return Message(sentence, name=obj.name, mover=mover) if mover else None


def _unsteady_curve(obj: "bpy.types.Object") -> Message | None:
    mover = what_moves(obj)
    sentence = (
        "'{name}' is moved by {mover}, and curves that avoid something must keep their places; "
        "remove that, or avoid nothing"
    )
    return Message(sentence, name=obj.name, mover=mover) if mover else None


def what_changes(obj: "bpy.types.Object", relaxed: Sequence["bpy.types.Object"] = ()) -> Message | None:
    """Say what may move an object or change its shape, or return None if nothing does.

    What its shape is made with may be relaxed, or move or change itself.
    """
    return _changed(obj, relaxed, set())


def _changed(
    obj: "bpy.types.Object", relaxed: Sequence["bpy.types.Object"], seen: "set[bpy.types.ID]"
) -> Message | None:
    seen.add(obj)
    return what_moves(obj) or next(_changes(obj, relaxed, seen), None)


def _changes(
    obj: "bpy.types.Object", relaxed: Sequence["bpy.types.Object"], seen: "set[bpy.types.ID]"
) -> Iterator[Message]:
    """Reasons why a shape may change, but for what was seen already."""

    def changing(blocks: "Iterable[bpy.types.ID]") -> bool:
        found = (each for each in blocks if each not in seen)
        return any(_changed(each, relaxed, seen) if each.id_type == "OBJECT" else _is_animated(each) for each in found)

    if obj in relaxed:
        yield Message("the relaxation itself")
    if any(map(_is_animated, (obj, obj.data, getattr(obj.data, "shape_keys", None)))):
        yield Message("animation of its shape")
    if obj.pose is not None and any(not each.mute for bone in obj.pose.bones for each in bone.constraints):
        yield Message("a constraint")
    if obj.data is not None and changing(chain(ingredients(obj.data), metaballs(obj))):
        yield Message("an object that its shape is made with")
    for modifier in obj.modifiers:
        if modifier.show_viewport and (_is_changing(modifier) or changing(ingredients(modifier))):
            yield Message("the modifier '{modifier}'", modifier=modifier.name)


def _is_animated(block: "bpy.types.ID | None") -> bool:
    """Whether a datablock has animation that may change a shape; where an object goes is told by `what_moves`."""
    if block is None or block.animation_data is None:
        return False
    animation = block.animation_data
    curves = [*(fcurves_of(block) if animation.action else ()), *animation.drivers]
    paths = _SHAPING if block.id_type == "OBJECT" else ""
    return bool(animation.nla_tracks) or any(curve.data_path.startswith(paths) for curve in curves)


def _is_changing(modifier: "bpy.types.Modifier") -> bool:
    """Whether a modifier shows something else at every frame."""
    if modifier.type == "PARTICLE_SYSTEM":
        return bool(modifier.particle_system.settings.type == "EMITTER")
    if modifier.type == "NODES":
        return any(node.bl_idname in _CHANGING_NODES for node in nodes_of(modifier.node_group, set()))
    return modifier.type in _CHANGING
