"""What is kept with a scene of its film: `Scene.mobius_flow_film`."""

import bpy
from bpy.props import EnumProperty, PointerProperty, StringProperty

from .pictures.looks import LOOKS

# since 5.0 Blender marks relative paths as wrong where a property does not say that it knows them
_RELATIVE = {"PATH_SUPPORTS_BLEND_RELATIVE"} if bpy.app.version >= (5, 0) else set()


class MobiusFlowFilmSettings(bpy.types.PropertyGroup):
    """Where the film goes, and what it looks like."""

    __annotations__ = {
        "filepath": StringProperty(
            name="File",
            description="Where the film goes, an MP4; // is the directory of the open file",
            default="//film.mp4",
            subtype="FILE_PATH",
            options=_RELATIVE,
        ),
        "look": EnumProperty(
            name="Look",
            description="How the frames are rendered",
            items=[(name, look.label, look.description) for name, look in LOOKS.items()],
        ),
    }


def register() -> None:
    """Give the scene the settings."""
    bpy.types.Scene.mobius_flow_film = PointerProperty(type=MobiusFlowFilmSettings)


def unregister() -> None:
    """Take them away."""
    del bpy.types.Scene.mobius_flow_film


CLASSES = (MobiusFlowFilmSettings,)
