"""What curves avoid, as the 3D view shows it when a relaxation begins, and what lies near and is not avoided."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import chain

import bpy
import numpy as np

from ...core import MobiusFlowError, Obstacle
from ...core.messages import Message
from ..engine.obstacles import obstacles
from ..engine.placement import Placement
from ..engine.words import named
from .moving import unsteady
from .reference import Reference
from .splines import read
from .surfaces import SOLID, WITHOUT_SHAPE, surfaces

STAGE = "mobius_flow_stage"  # custom property of what only surrounds curves, to be seen with them
TUBE_OF = "mobius_flow_tube_of"  # custom property of a tube's mesh: the curve object that it was made of
_MARGIN = 0.1  # of the diagonal of the curves' box


def avoidable(
    collection: bpy.types.Collection | None, relaxed: Sequence[bpy.types.Object]
) -> Iterator[bpy.types.Object]:
    """Yield what of a collection is visible, has a shape, and is not relaxed itself."""
    for obj in collection.all_objects if collection is not None else ():
        bare = obj.type == "EMPTY" and obj.instance_type == "NONE"
        if not bare and obj.type not in WITHOUT_SHAPE and obj not in relaxed and obj.visible_get():
            yield obj


def add(scene: bpy.types.Scene, objects: Sequence[bpy.types.Object]) -> bpy.types.Collection:
    """Add objects to the collection that the scene's curves avoid, which is made where there is none.

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
        """Say what somebody did to one of the objects that makes what was proved of them pointless."""
        return next((reason for place in self._places if (reason := place.lost())), None)


NOTHING = Surroundings()


def warning(
    context: bpy.types.Context, objects: Sequence[bpy.types.Object], avoided: Sequence[bpy.types.Object] = ()
) -> Message | None:
    """Name what is visible near curve objects, and neither one of them nor avoided by them, or return None."""
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
