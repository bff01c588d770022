"""What Blender is told about at registration, and forgets at unregistration."""

import bpy
from bpy.props import PointerProperty

from . import baking, operators, panel
from .live import handlers
from .live import operators as of_runs
from .properties import MobiusFlowSettings

_CLASSES = (MobiusFlowSettings, *operators.CLASSES, *of_runs.CLASSES, *baking.CLASSES, *panel.CLASSES)


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
    bpy.types.VIEW3D_MT_curve_add.append(panel.add_menu_entry)
    handlers.register()


def unregister() -> None:
    """Remove all of it; what is running ends first."""
    handlers.unregister()
    bpy.types.VIEW3D_MT_curve_add.remove(panel.add_menu_entry)
    del bpy.types.Scene.mobius_flow
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
