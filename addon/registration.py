"""What Blender is told about at registration, and forgets at unregistration."""

import bpy
from bpy.props import PointerProperty

from . import buttons, sidebar
from .buttons import gallery
from .live import handlers
from .properties import MobiusFlowSettings
from .sidebar import menus

_CLASSES = (MobiusFlowSettings, *buttons.CLASSES, *sidebar.CLASSES)


def register() -> None:
    """Add the classes, the settings and the menu entry; an error leaves nothing half done."""
    done = []
    try:
        for cls in _CLASSES:
            bpy.utils.register_class(cls)
            done.append(cls)
    except Exception:
        for cls in reversed(done):
            bpy.utils.unregister_class(cls)
        raise
    bpy.types.Scene.mobius_flow = PointerProperty(type=MobiusFlowSettings)
    bpy.types.Scene.mobius_flow_knots = PointerProperty(type=gallery.MobiusFlowKnots)
    menus.register()
    handlers.register()


def unregister() -> None:
    """Remove all of it; what is running ends first."""
    handlers.unregister()
    menus.unregister()
    del bpy.types.Scene.mobius_flow_knots, bpy.types.Scene.mobius_flow
    gallery.unregister()
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
