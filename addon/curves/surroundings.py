"""What curves avoid, as the 3D view shows it when a relaxation begins, and nearby objects that are not avoided.

Objects count with their modifiers and everything they show copies of, as triangles and edges.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import chain

import bpy
import numpy as np

from ...core import MobiusFlowError, Obstacle
from ...core.messages import Message
from ..engine.obstacles import Surface, obstacles
from ..engine.placement import Placement
from ..engine.words import named
from .exchange import Reference
from .moving import unsteady, unsteady_object
from .splines import read

STAGE = "mobius_flow_stage"  # custom property of objects that only surround curves, to be seen with them
TUBE_OF = "mobius_flow_tube_of"  # custom property of a tube's mesh: the curve object that it was made of
_MARGIN = 0.1  # of the diagonal of the curves' box
SOLID = {"CURVE", "MESH", "SURFACE", "META", "FONT"}  # what Blender makes meshes of
WITHOUT_SHAPE = {"ARMATURE", "CAMERA", "LATTICE", "LIGHT", "LIGHT_PROBE", "SPEAKER"}


def avoidable(
    collection: bpy.types.Collection | None, relaxed: Sequence[bpy.types.Object]
) -> Iterator[bpy.types.Object]:
    """Yield the objects of a collection that are visible, have a shape, and are not relaxed themselves."""
    for obj in collection.all_objects if collection is not None else ():
        bare = obj.type == "EMPTY" and obj.instance_type == "NONE"
        if not bare and obj.type not in WITHOUT_SHAPE and obj not in relaxed and obj.visible_get():
            yield obj


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


@dataclass(frozen=True)
class _Place:
    """Where an object was."""

    reference: Reference
    placement: Placement

    def lost(self) -> Message | None:
        obj = self.reference.get()
        if obj is None or not obj.users_scene:
            return Message("'{name}' was deleted", name=self.reference.name)
        if obj.mode != "OBJECT":
            return Message("'{name}' is being edited", name=obj.name)
        if not Placement.from_matrix(obj.matrix_world).equals(self.placement):
            return Message("'{name}' was moved against the others", name=obj.name)
        return None


@dataclass(frozen=True, eq=False)
class Surroundings:
    """Objects that are avoided; nothing of them is touched."""

    obstacles: tuple[Obstacle, ...] = ()  # what they show, in the world
    _places: tuple[_Place, ...] = ()

    @classmethod
    def of(cls, avoided: Sequence[bpy.types.Object], relaxed: Sequence[bpy.types.Object]) -> "Surroundings":
        """Read objects as they are shown at the current frame.

        Raises MobiusFlowError if one of them is hidden, moves, or shows nothing that can be avoided, or a curve that is
        relaxed moves.
        """
        others = [obj for obj in dict.fromkeys(avoided) if obj not in relaxed]
        if reason := unsteady(others, relaxed):
            raise MobiusFlowError(reason)
        shown = surfaces(bpy.context.evaluated_depsgraph_get(), others, relaxed) if others else []
        each = (obstacles(obj.name, pieces) for obj, pieces in zip(others, shown, strict=True))
        places = (_Place(Reference(obj), Placement.from_matrix(obj.matrix_world)) for obj in others)
        return cls(tuple(chain.from_iterable(each)), tuple(places))

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(place.reference.name for place in self._places)

    def lost(self) -> Message | None:
        """Say what was done to one of the objects that makes the proofs about them pointless."""
        return next((reason for place in self._places if (reason := place.lost())), None)


NOTHING = Surroundings()


def warning(
    context: bpy.types.Context, objects: Sequence[bpy.types.Object], avoided: Sequence[bpy.types.Object] = ()
) -> Message | None:
    """Name what is visible near curve objects, but neither one of them nor avoided by them, or return None."""
    if not (found := near(context, objects, avoided)):
        return None
    names = named([obj.name for obj in found])
    if len(found) > 1:
        return Message("{names} nearby are neither selected nor avoided, and may be crossed", names=names)
    return Message("{names} nearby is neither selected nor avoided, and may be crossed", names=names)


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
    margin = _MARGIN * np.linalg.norm(highest - lowest)
    overlap = (low <= highest + margin).all(axis=1) & (high >= lowest - margin).all(axis=1)
    candidates = (everything[int(k)] for k in np.flatnonzero(overlap & ~mine))
    others = (obj for obj in candidates if obj.type in SOLID and obj not in avoided)
    return [obj for obj in others if STAGE not in obj and obj.get(TUBE_OF) not in together and obj.visible_get()]


def surfaces(
    depsgraph: bpy.types.Depsgraph, objects: Sequence[bpy.types.Object], relaxed: Sequence[bpy.types.Object]
) -> list[list[Surface]]:
    """What each of some objects shows, piece by piece.

    Raises MobiusFlowError if one of them is hidden, or shows what cannot be avoided: something other than faces and
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
    """Refuse the type of an object, or of a part that it shows besides, if it is not a mesh and cannot be made one.

    Geometry nodes can give an object parts of other types, such as points; curves among them are not made into meshes.
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
