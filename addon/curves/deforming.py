"""What moves the points of a curve after its keys have: a proof about the points says nothing of what is shown then."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from ...core.messages import Message

if TYPE_CHECKING:
    import bpy

_DEFORMING = {
    "ARMATURE",
    "CAST",
    "CLOTH",
    "CORRECTIVE_SMOOTH",
    "CURVE",
    "DISPLACE",
    "HOOK",
    "LAPLACIANDEFORM",
    "LAPLACIANSMOOTH",
    "LATTICE",
    "MESH_CACHE",
    "MESH_DEFORM",
    "MESH_SEQUENCE_CACHE",
    "SHRINKWRAP",
    "SIMPLE_DEFORM",
    "SMOOTH",
    "SOFT_BODY",
    "SURFACE_DEFORM",
    "WARP",
    "WAVE",
}
_DEFORMING_PARENTS = {"ARMATURE", "LATTICE"}  # types of parenting
_MOVING_NODES = {"GeometryNodeSetPosition", "GeometryNodeSetCurveHandlePositions"}


def what_deforms(obj: "bpy.types.Object") -> Message | None:
    """Say what may move an object's points, of all that is shown, or return None if nothing does."""
    if obj.parent and obj.parent_type in _DEFORMING_PARENTS:
        return Message("The parent of '{name}'", name=obj.name)
    shown = (each for each in obj.modifiers if each.show_viewport or each.show_render)
    first = next((each for each in shown if deforms(each)), None)
    return Message("The modifier '{modifier}' of '{name}'", modifier=first.name, name=obj.name) if first else None


def deforms(modifier: "bpy.types.Modifier") -> bool:
    """Whether a modifier may move points of a curve.

    Others add to what is drawn, as a bevel does; of geometry nodes those do that have no node for positions.
    """
    if modifier.type == "NODES":
        return any(node.bl_idname in _MOVING_NODES for node in nodes_of(modifier.node_group, set()))
    return modifier.type in _DEFORMING


def nodes_of(tree: "bpy.types.NodeTree | None", seen: "set[bpy.types.NodeTree]") -> "Iterator[bpy.types.Node]":
    """Yield the nodes of a tree and of the groups in it that are not muted, each tree once."""
    if tree is None or tree in seen:
        return
    seen.add(tree)
    for node in tree.nodes:
        if not node.mute:
            yield node
            yield from nodes_of(getattr(node, "node_tree", None), seen)
