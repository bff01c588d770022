"""What is kept with a scene of the surroundings of its curves: `Scene.mobius_flow_surroundings`."""

import bpy
from bpy.props import PointerProperty


class MobiusFlowSurroundings(bpy.types.PropertyGroup):
    """What curves avoid."""

    __annotations__ = {
        "avoid": PointerProperty(
            name="Avoid",
            description="Collection whose visible objects are never touched by curves that are relaxed",
            type=bpy.types.Collection,
        ),
    }


def register() -> None:
    """Give the scene the settings."""
    bpy.types.Scene.mobius_flow_surroundings = PointerProperty(type=MobiusFlowSurroundings)


def unregister() -> None:
    """Take them away."""
    del bpy.types.Scene.mobius_flow_surroundings


CLASSES = (MobiusFlowSurroundings,)
