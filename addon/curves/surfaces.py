"""What objects show in the 3D view, with their modifiers and all that they show copies of, as triangles and edges."""

from collections.abc import Sequence

import bpy
import numpy as np

from ...core import MobiusFlowError
from ...core.messages import Message
from ..engine.obstacles import Surface
from ..engine.placement import Placement
from .moving import unsteady_object
from .splines import read

SOLID = {"CURVE", "MESH", "SURFACE", "META", "FONT"}  # what Blender makes meshes of
WITHOUT_SHAPE = {"ARMATURE", "CAMERA", "LATTICE", "LIGHT", "LIGHT_PROBE", "SPEAKER"}


def surfaces(
    depsgraph: bpy.types.Depsgraph, objects: Sequence[bpy.types.Object], relaxed: Sequence[bpy.types.Object]
) -> list[list[Surface]]:
    """What each of some objects shows, piece by piece.

    Raises MobiusFlowError if one of them is hidden, or shows what cannot be avoided: something else than faces and
    edges, or a copy of an object that does not stand still while others are relaxed.
    """
    shown: dict[int, list[Surface]] = {obj.session_uid: [] for obj in objects}
    looked_at: set[int] = set()
    for obj in objects:
        if not obj.visible_get():
            raise MobiusFlowError(Message("'{name}' is hidden; show it first, or leave it out", name=obj.name))
        if obj.mode != "OBJECT":
            raise MobiusFlowError(Message("'{name}' is being edited; go back to Object Mode first", name=obj.name))
    for instance in depsgraph.object_instances:
        owner = (instance.parent if instance.is_instance else instance.object).original
        pieces = shown.get(owner.session_uid)
        if pieces is None or not instance.show_self:
            continue
        source = instance.object.original
        if source.session_uid not in looked_at:
            looked_at.add(source.session_uid)
            if said := unsteady_object(source, relaxed):
                raise MobiusFlowError(said)
        _check_kind(source, instance.object.type)
        piece = _surface(instance)
        # curves, texts and so on are shown a second time, as the meshes that are made of them
        if piece is not None and not any(map(piece.equals, pieces)):
            pieces.append(piece)
    return [shown[obj.session_uid] for obj in objects]


def _check_kind(obj: bpy.types.Object, shown: str) -> None:
    """Refuse what is neither a mesh nor can be made one: an object's type, or that of a part which it shows besides.

    Geometry nodes can give an object parts of other types, such as points; of curves among them no mesh is made.
    """
    unknown = shown not in SOLID | WITHOUT_SHAPE | {"EMPTY"}
    if unknown or shown not in (obj.type, "MESH"):
        kind = obj.bl_rna.properties["type"].enum_items[shown].name
        sentence = "'{name}' is of type {type}, which cannot be avoided; convert it to a mesh, or leave it out"
        beside = "'{name}' shows a {type} too, which cannot be avoided; convert it to a mesh, or leave it out"
        raise MobiusFlowError(Message(sentence if shown == obj.type else beside, name=obj.name, type=kind))


def _surface(instance: bpy.types.DepsgraphObjectInstance) -> Surface | None:
    """The mesh that is shown at one place; None if there is none."""
    obj = instance.object
    mesh = obj.to_mesh() if obj.type in SOLID else None
    if mesh is None:
        return None
    try:
        mesh.calc_loop_triangles()
        points = read(mesh.vertices, "co", 3)
        triangles = read(mesh.loop_triangles, "vertices", 3, np.int32)
        edges = read(mesh.edges, "vertices", 2, np.int32)
        return Surface.of_mesh(points, triangles, edges, Placement.from_matrix(instance.matrix_world))
    finally:
        obj.to_mesh_clear()
