"""What curves avoid, as the 3D view shows it when a relaxation begins, and nearby objects that are not avoided.

Objects count with their modifiers and everything they show copies of, as triangles and edges.
"""

from collections.abc import Iterator, Sequence

import bpy
import numpy as np

from ...core import CurveError, MobiusFlowError, Obstacle
from ...core.base import FloatArray, IntArray, Message
from ...core.driver.words import named
from ...core.keys.placement import Placement
from .moving import unsteady
from .splines import Reference, read

STAGE = "mobius_flow_stage"  # custom property of objects that only surround curves, to be seen with them
CARRIER = "mobius_flow_carrier"  # of a copy of hair, strokes or edges: the curve object whose motion it shows
TUBE_OF = "mobius_flow_tube_of"  # custom property of a tube's mesh: the curve object that it was made of
SOLID = {"CURVE", "MESH", "SURFACE", "META", "FONT"}  # what Blender makes meshes of
WITHOUT_SHAPE = {"ARMATURE", "CAMERA", "LATTICE", "LIGHT", "LIGHT_PROBE", "SPEAKER"}


def add(scene: bpy.types.Scene, objects: Sequence[bpy.types.Object]) -> bpy.types.Collection:
    """Add objects to the collection that the scene's curves avoid, which is made if there is none.

    Raises MobiusFlowError if the collection belongs to another file.
    """
    settings = scene.mobius_flow_surroundings
    if settings.avoid is None:
        settings.avoid = bpy.data.collections.new("Avoid")
        scene.collection.children.link(settings.avoid)
    if settings.avoid.library or settings.avoid.override_library:
        sentence = "'{name}' is linked from another file; choose another collection to avoid"
        raise MobiusFlowError(Message(sentence, name=settings.avoid.name))
    for obj in objects:
        settings.avoid.objects.link(obj)
    return settings.avoid


class Surroundings:
    """Objects that are avoided, as they are shown at the current frame; nothing of them is touched.

    Raises MobiusFlowError if one of them is hidden, moves, or shows nothing that can be avoided, or a curve that is
    relaxed moves.
    """

    def __init__(self, avoided: Sequence[bpy.types.Object], relaxed: Sequence[bpy.types.Object]) -> None:
        others = [obj for obj in dict.fromkeys(avoided) if obj not in relaxed]
        if reason := unsteady(others, relaxed):
            raise MobiusFlowError(reason)
        self.obstacles = tuple(_obstacles(others, relaxed))  # what they show, in the world
        self._places = [(Reference(obj), Placement.from_matrix(obj.matrix_world)) for obj in others]

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(reference.name for reference, _ in self._places)

    def lost(self) -> Message | None:
        """Say what was done to one of the objects that makes the proofs about them pointless."""
        for reference, placement in self._places:
            obj = reference.get()
            if obj is None or not obj.users_scene:
                return Message("'{name}' was deleted", name=reference.name)
            if obj.mode != "OBJECT":
                return Message("'{name}' is being edited", name=obj.name)
            if not Placement.from_matrix(obj.matrix_world).equals(placement):
                return Message("'{name}' was moved against the others", name=obj.name)
        return None


def warning(
    context: bpy.types.Context, objects: Sequence[bpy.types.Object], avoided: Sequence[bpy.types.Object] = ()
) -> Message | None:
    """Name what is visible near curve objects, but neither one of them nor avoided by them, or return None."""
    if not (found := near(context, objects, avoided)):
        return None
    one = "{names} nearby is neither selected nor avoided, and may be crossed"
    several = "{names} nearby are neither selected nor avoided, and may be crossed"
    return Message(several if len(found) > 1 else one, names=named([obj.name for obj in found]))


def near(
    context: bpy.types.Context, objects: Sequence[bpy.types.Object], avoided: Sequence[bpy.types.Object] = ()
) -> list[bpy.types.Object]:
    """Other visible objects with a surface or a line whose boxes in the world overlap those of the curves, enlarged.

    Cheap enough for every redraw.
    """
    everything = context.view_layer.objects
    together = set(objects)
    mine = np.array([obj in together for obj in everything], dtype=bool)
    if not mine.any():
        return []
    matrices = read(everything, "matrix_world", 16).reshape(-1, 4, 4)  # column by column
    corners = read(everything, "bound_box", 24).reshape(-1, 8, 3) @ matrices[:, :3, :3] + matrices[:, 3:, :3]
    low, high = corners.min(axis=1), corners.max(axis=1)
    lowest, highest = low[mine].min(axis=0), high[mine].max(axis=0)
    margin = 0.1 * np.linalg.norm(highest - lowest)
    overlap = (low <= highest + margin).all(axis=1) & (high >= lowest - margin).all(axis=1)
    candidates = (everything[int(k)] for k in np.flatnonzero(overlap & ~mine))
    others = (obj for obj in candidates if obj.type in SOLID and obj not in avoided)
    others = (obj for obj in others if not {obj.get(TUBE_OF), obj.get(CARRIER)} & together)
    return [obj for obj in others if STAGE not in obj and obj.visible_get()]


def _obstacles(objects: Sequence[bpy.types.Object], relaxed: Sequence[bpy.types.Object]) -> Iterator[Obstacle]:
    """Yield what each of some objects shows in the world, all of its parts together.

    These are its triangles, and its edges that belong to none. Raises MobiusFlowError if an object is hidden, or shows
    nothing, what is not finite, or what cannot be avoided: something other than faces and edges, or a copy of an object
    that does not stand still while others are relaxed.
    """
    # points, triangles and edges of each piece, by their bytes: curves, texts and so on are shown a second time, as the
    # meshes that are made of them
    shown: dict[int, dict[bytes, tuple[FloatArray, IntArray, IntArray]]] = {obj.session_uid: {} for obj in objects}
    looked_at: set[int] = set()
    for obj in objects:
        if not obj.visible_get():
            raise MobiusFlowError(Message("'{name}' is hidden; show it first, or leave it out", name=obj.name))
        if obj.mode != "OBJECT":
            raise MobiusFlowError(Message("'{name}' is being edited; go back to Object Mode first", name=obj.name))
    for instance in bpy.context.evaluated_depsgraph_get().object_instances if objects else ():
        owner = (instance.parent if instance.is_instance else instance.object).original
        if owner.session_uid not in shown or not instance.show_self:
            continue
        source = instance.object.original
        if source.session_uid not in looked_at:
            looked_at.add(source.session_uid)
            if said := unsteady([source], relaxed):
                raise MobiusFlowError(said)
        # geometry nodes can give an object parts of other types, such as points; curves among them are not made meshes
        evaluated, kind = instance.object, instance.object.type
        unknown = kind not in SOLID | WITHOUT_SHAPE | {"EMPTY"}
        if unknown or kind not in (source.type, "MESH"):
            title = source.bl_rna.properties["type"].enum_items[kind].name
            sentence = "'{name}' is of type {type}, which cannot be avoided; convert it to a mesh, or leave it out"
            beside = "'{name}' shows a {type} too, which cannot be avoided; convert it to a mesh, or leave it out"
            raise MobiusFlowError(Message(sentence if kind == source.type else beside, name=source.name, type=title))
        if kind not in SOLID or (mesh := evaluated.to_mesh()) is None:
            continue
        try:
            mesh.calc_loop_triangles()
            points = read(mesh.vertices, "co", 3).astype(np.float64)
            piece = (
                Placement.from_matrix(instance.matrix_world).to_world(points),
                read(mesh.loop_triangles, "vertices", 3, np.int32).astype(np.intp),
                read(mesh.edges, "vertices", 2, np.int32).astype(np.intp),
            )
        finally:
            evaluated.to_mesh_clear()
        shown[owner.session_uid][b"".join(array.tobytes() for array in piece)] = piece
    for obj in objects:
        pieces, first = [(np.empty((0, 3)), np.empty((0, 3), dtype=np.intp), np.empty((0, 2), dtype=np.intp))], 0
        for points, triangles, edges in shown[obj.session_uid].values():
            pieces.append((points, triangles + first, edges + first))
            first += len(points)
        vertices, triangles, edges = (np.concatenate(arrays) for arrays in zip(*pieces, strict=True))
        sides = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1) @ [first, 1]
        loose = edges[~np.isin(np.sort(edges, axis=1) @ [first, 1], sides)]
        if not len(triangles) + len(loose):
            sentence = "'{name}' shows neither faces nor edges; leave it out of what is avoided"
            raise CurveError(Message(sentence, name=obj.name))
        for simplices in filter(len, (triangles, loose)):
            used, corners = np.unique(simplices, return_inverse=True)
            if not (np.abs(vertices[used]) < 1e30).all():  # Blender clamps infinite ones to the largest 32-bit number
                sentence = "A point of '{name}' is not finite, or further away than anything; repair or delete it"
                raise CurveError(Message(sentence, name=obj.name))
            yield Obstacle(vertices[used], corners.reshape(simplices.shape), obj.name)
