"""What curves avoid: objects that are not relaxed, as the 3D view shows them when a relaxation begins."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import TYPE_CHECKING

from ...core import MobiusFlowError, Obstacle
from ...core.messages import Message
from ..engine.obstacles import obstacles
from ..engine.placement import Placement
from .reference import Reference
from .standing import unsteady
from .surfaces import WITHOUT_SHAPE, surfaces

if TYPE_CHECKING:
    import bpy


def avoidable(
    collection: "bpy.types.Collection | None", relaxed: Sequence["bpy.types.Object"]
) -> Iterator["bpy.types.Object"]:
    """Yield what of a collection is visible, has a shape, and is not relaxed itself."""
    for obj in collection.all_objects if collection is not None else ():
        bare = obj.type == "EMPTY" and obj.instance_type == "NONE"
        if not bare and obj.type not in WITHOUT_SHAPE and obj not in relaxed and obj.visible_get():
            yield obj


def add(scene: "bpy.types.Scene", objects: Sequence["bpy.types.Object"]) -> "bpy.types.Collection":
    """Add objects to the collection that the scene's curves avoid, which is made where there is none.

    Raises
    ------
    MobiusFlowError
        If the collection belongs to another file.
    """
    import bpy

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
        """Say what somebody did to the object."""
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
    """Objects that are avoided; nothing of them is touched.

    Attributes
    ----------
    obstacles
        What they show, in the world.
    """

    obstacles: tuple[Obstacle, ...] = ()
    _places: tuple[_Place, ...] = ()

    @classmethod
    def of(cls, avoided: Sequence["bpy.types.Object"], relaxed: Sequence["bpy.types.Object"]) -> "Surroundings":
        """Read objects as they are shown at the current frame.

        Raises
        ------
        MobiusFlowError
            If one of them is hidden, moves, or shows nothing that can be avoided, or a curve that is relaxed moves.
        """
        import bpy

        others = [obj for obj in dict.fromkeys(avoided) if obj not in relaxed]
        if reason := unsteady(others, relaxed):
            raise MobiusFlowError(reason)
        shown = surfaces(bpy.context.evaluated_depsgraph_get(), others, relaxed) if others else []
        each = (obstacles(obj.name, pieces) for obj, pieces in zip(others, shown, strict=True))
        places = (_Place(Reference(obj), Placement.from_matrix(obj.matrix_world)) for obj in others)
        return cls(tuple(chain.from_iterable(each)), tuple(places))

    @property
    def names(self) -> tuple[str, ...]:
        """The objects' names."""
        return tuple(place.reference.name for place in self._places)

    def lost(self) -> Message | None:
        """Say what somebody did to one of the objects that makes what was proved of them pointless."""
        return next((reason for place in self._places if (reason := place.lost())), None)


NOTHING = Surroundings()
