"""What Blender is told about at registration, and forgets at unregistration."""

import bpy
from bpy.props import PointerProperty

from .baking import (
    CURVE_OT_mobius_flow_bake_again,
    CURVE_OT_mobius_flow_clear,
    CURVE_OT_mobius_flow_continue,
    CURVE_OT_mobius_flow_scene_range,
)
from .live import handlers
from .live.operators import (
    CURVE_OT_mobius_flow_cancel,
    CURVE_OT_mobius_flow_pause,
    CURVE_OT_mobius_flow_recover,
    CURVE_OT_mobius_flow_sample,
    CURVE_OT_mobius_flow_stop,
)
from .operators import CURVE_OT_mobius_flow_add_knot, CURVE_OT_mobius_flow_relax
from .panel import (
    VIEW3D_PT_mobius_flow,
    VIEW3D_PT_mobius_flow_advanced,
    VIEW3D_PT_mobius_flow_animation,
    add_menu_entry,
)
from .properties import MobiusFlowSettings

_CLASSES = (
    MobiusFlowSettings,
    CURVE_OT_mobius_flow_relax,
    CURVE_OT_mobius_flow_pause,
    CURVE_OT_mobius_flow_stop,
    CURVE_OT_mobius_flow_cancel,
    CURVE_OT_mobius_flow_recover,
    CURVE_OT_mobius_flow_sample,
    CURVE_OT_mobius_flow_bake_again,
    CURVE_OT_mobius_flow_continue,
    CURVE_OT_mobius_flow_clear,
    CURVE_OT_mobius_flow_scene_range,
    CURVE_OT_mobius_flow_add_knot,
    VIEW3D_PT_mobius_flow,
    VIEW3D_PT_mobius_flow_animation,
    VIEW3D_PT_mobius_flow_advanced,
)


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
    bpy.types.VIEW3D_MT_curve_add.append(add_menu_entry)
    handlers.register()


def unregister() -> None:
    """Remove all of it; what is running ends first."""
    handlers.unregister()
    bpy.types.VIEW3D_MT_curve_add.remove(add_menu_entry)
    del bpy.types.Scene.mobius_flow
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
