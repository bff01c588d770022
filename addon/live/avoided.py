"""What the scene, or a script, wants the selected curves to avoid."""

from typing import TYPE_CHECKING

from ...core import MobiusFlowError
from ...core.messages import Message
from ..curves.surroundings import avoidable
from .checks import selected_curves

if TYPE_CHECKING:
    import bpy


def avoided(context: "bpy.types.Context", name: str | None = None) -> list["bpy.types.Object"]:
    """The visible objects of the scene's collection to avoid, or of one given by name, but for the selected curves.

    Raises
    ------
    MobiusFlowError
        If there is no collection of that name; an empty one means to avoid nothing.
    """
    collection = context.scene.mobius_flow_surroundings.avoid if name is None else _collection(name)
    return list(avoidable(collection, selected_curves(context)))


def _collection(name: str) -> "bpy.types.Collection | None":
    import bpy

    found = bpy.data.collections.get(name)
    if name and found is None:
        raise MobiusFlowError(Message("There is no collection '{name}' to avoid", name=name))
    return found
