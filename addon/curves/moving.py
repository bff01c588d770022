"""What moves objects, their points, or what they show.

Curves that are relaxed together, or avoid something, must stay in place, and avoided objects must keep their shape too.
A proof about a curve's points says nothing about what is shown if something moves the points after the keys have.
"""

from collections.abc import Iterable, Iterator, Sequence
from itertools import chain
from typing import Any

import bpy

from ...core.base import Message
from . import sizes
from .keyframes import fcurves_of

_TRANSFORMS = ("location", "rotation", "scale", "delta_", "matrix", "parent")
# fmt: off
_DEFORMING = {
    "ARMATURE", "CAST", "CLOTH", "CORRECTIVE_SMOOTH", "CURVE", "DISPLACE", "HOOK", "LAPLACIANDEFORM", "LAPLACIANSMOOTH",
    "LATTICE", "MESH_CACHE", "MESH_DEFORM", "MESH_SEQUENCE_CACHE", "SHRINKWRAP", "SIMPLE_DEFORM", "SMOOTH", "SOFT_BODY",
    "SURFACE_DEFORM", "WARP", "WAVE", *(f"GREASE_PENCIL_{name}" for name in (
        "ARMATURE", "ARRAY", "BUILD", "ENVELOPE", "HOOK", "LATTICE", "MIRROR", "MULTIPLY", "NOISE", "OFFSET",
        "SHRINKWRAP", "SIMPLIFY", "SMOOTH", "SUBDIV", "TIME",
    ))
}
_CHANGING = {
    "BUILD", "CLOTH", "DYNAMIC_PAINT", "EXPLODE", "FLUID", "MESH_CACHE", "MESH_SEQUENCE_CACHE", "OCEAN",
    "PARTICLE_INSTANCE", "SOFT_BODY", "WAVE",
}
# fmt: on
_DEFORMING_NODES = {"GeometryNodeSetPosition", "GeometryNodeSetCurveHandlePositions"}
_CHANGING_NODES = {"GeometryNodeInputSceneTime", "GeometryNodeSimulationInput"}


def what_moves(obj: bpy.types.Object) -> Message | None:
    """Say what may move an object or one of its parents by itself, or return None if nothing does."""
    animation = obj.animation_data
    if animation and animation.nla_tracks:
        return Message("an NLA track")
    if animation and animation.action and _any_of(fcurves_of(obj), _TRANSFORMS):
        return Message("animation")
    if animation and _any_of(animation.drivers, _TRANSFORMS):
        return Message("a driver")
    if any(not (each.mute or sizes.is_own(each)) for each in obj.constraints):
        return Message("a constraint")
    if obj.rigid_body and obj.rigid_body.type == "ACTIVE":  # a passive one is hit, and stays where it is
        return Message("physics")
    # a parent carries an object along when it moves, and some do when they change their shape or pose
    if obj.parent and (obj.parent_type != "OBJECT" or (obj.parent.type == "CURVE" and obj.parent.data.use_path)):
        return Message("its parent")
    mover = what_moves(obj.parent) if obj.parent else None
    return mover if mover in (None, "its parent") else Message("{mover} of its parent", mover=mover)


def _any_of(curves: Iterable[bpy.types.FCurve], paths: tuple[str, ...] | str) -> bool:
    return any(curve.data_path.startswith(paths) for curve in curves)


def what_deforms(obj: bpy.types.Object) -> Message | None:
    """Say what may move an object's points, of all that is shown, or return None if nothing does."""
    if obj.parent and obj.parent_type in {"ARMATURE", "LATTICE"}:
        return Message("The parent of '{name}'", name=obj.name)
    shown = (each for each in obj.modifiers if each.show_viewport or each.show_render)
    first = next((each for each in shown if deforms(each)), None)
    return Message("The modifier '{modifier}' of '{name}'", modifier=first.name, name=obj.name) if first else None


def deforms(modifier: bpy.types.Modifier) -> bool:
    """Whether a modifier may move points of a curve.

    Others add to what is drawn, as a bevel does; so do geometry nodes without a node that sets positions.
    """
    return _is_of(modifier, _DEFORMING, _DEFORMING_NODES)


def _is_of(modifier: bpy.types.Modifier, types: set[str], nodes: set[str]) -> bool:
    if modifier.type == "NODES":
        return any(node.bl_idname in nodes for node in _nodes_of(modifier.node_group, set()))
    return modifier.type in types


def _nodes_of(tree: bpy.types.NodeTree | None, seen: set[bpy.types.NodeTree]) -> Iterator[bpy.types.Node]:
    """Yield the nodes of a tree and of the groups in it that are not muted, each tree once."""
    if tree is None or tree in seen:
        return
    seen.add(tree)
    for node in tree.nodes:
        if not node.mute:
            yield node
            yield from _nodes_of(getattr(node, "node_tree", None), seen)


def unsteady(avoided: Sequence[bpy.types.Object], relaxed: Sequence[bpy.types.Object]) -> Message | None:
    """Say what changes in avoided objects, or in curves that avoid them, or return None if nothing does."""
    for obj in avoided:
        if mover := what_changes(obj, relaxed):
            still = "'{name}' is moved by {mover}, and what is avoided must stand still; remove that, or leave it out \
of what is avoided"
            return Message(still, name=obj.name, mover=mover)
    for obj in relaxed if avoided else ():
        if mover := what_moves(obj):
            placed = "'{name}' is moved by {mover}, and curves that avoid something must keep their places; remove \
that, or avoid nothing"
            return Message(placed, name=obj.name, mover=mover)
    return None


def what_changes(
    obj: bpy.types.Object, relaxed: Sequence[bpy.types.Object] = (), seen: set[bpy.types.ID] | None = None
) -> Message | None:
    """Say what may move an object or change its shape, or return None if nothing does.

    What its shape is made with may be relaxed, or move or change itself. ``seen``: what was examined already.
    """
    seen = set() if seen is None else seen  # shared by all objects examined in turn
    seen.add(obj)

    def changing(blocks: Iterable[bpy.types.ID]) -> bool:
        found = (each for each in blocks if each not in seen)
        return any(
            what_changes(each, relaxed, seen) if each.id_type == "OBJECT" else _is_animated(each) for each in found
        )

    if mover := what_moves(obj):
        return mover
    if obj in relaxed:
        return Message("the relaxation itself")
    if any(map(_is_animated, (obj, obj.data, getattr(obj.data, "shape_keys", None)))):
        return Message("animation of its shape")
    if obj.pose is not None and any(not each.mute for bone in obj.pose.bones for each in bone.constraints):
        return Message("a constraint")
    stem = obj.name.partition(".")[0]  # metaballs with the same one form one surface
    balls = (each for each in bpy.data.objects if each.type == obj.type == "META")
    same = (each for each in balls if each.name.partition(".")[0] == stem)
    if obj.data is not None and changing(chain(_ingredients(obj.data), same)):
        return Message("an object that its shape is made with")
    for modifier in obj.modifiers:
        if modifier.type == "PARTICLE_SYSTEM":
            itself = modifier.particle_system.settings.type == "EMITTER"
        else:
            itself = _is_of(modifier, _CHANGING, _CHANGING_NODES)
        if modifier.show_viewport and (itself or changing(_ingredients(modifier))):
            return Message("the modifier '{modifier}'", modifier=modifier.name)
    return None


def _is_animated(block: bpy.types.ID | None) -> bool:
    """Whether a datablock has animation that may change a shape; `what_moves` says where an object goes."""
    if block is None or block.animation_data is None:
        return False
    animation = block.animation_data
    curves = [*(fcurves_of(block) if animation.action else ()), *animation.drivers]
    return bool(animation.nla_tracks) or _any_of(curves, ("modifiers", "pose") if block.id_type == "OBJECT" else "")


def _ingredients(block: bpy.types.bpy_struct) -> Iterator[bpy.types.ID]:
    """Yield what a modifier or other data refers to: objects, also those of collections, textures and node trees."""
    values: Iterable[Any] = ()  # of sockets: of a node, and of a modifier, which before 5.2 has custom properties
    if isinstance(block, bpy.types.Node):
        values = (getattr(socket, "default_value", None) for socket in block.inputs)
    elif isinstance(block, bpy.types.NodesModifier) and hasattr(block, "properties"):
        values = (getattr(socket, "value", None) for socket in _pointers(block.properties.inputs))
    elif isinstance(block, bpy.types.NodesModifier):
        values = (value for _, value in block.items())
    for each in chain(_pointers(block), values):
        if isinstance(each, bpy.types.Collection):
            yield from each.all_objects
        elif isinstance(each, bpy.types.Object | bpy.types.Texture):
            yield each
        elif isinstance(each, bpy.types.GeometryNodeTree):
            yield each
            for node in _nodes_of(each, set()):
                yield from _ingredients(node)


def _pointers(block: bpy.types.bpy_struct) -> "Iterator[Any]":
    return (getattr(block, each.identifier) for each in block.bl_rna.properties if each.type == "POINTER")
