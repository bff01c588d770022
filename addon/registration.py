"""What Blender is told about at registration, and forgets at unregistration."""

import bpy
from bpy.props import PointerProperty

from . import buttons, film_settings, panel_settings, sidebar, surroundings_settings, translations
from .buttons import gallery, presets
from .live import handlers, overlay
from .properties import MobiusFlowSettings
from .sidebar import menus

_SETTINGS = (panel_settings, film_settings, surroundings_settings)
_CLASSES = (MobiusFlowSettings, *(cls for part in (*_SETTINGS, buttons, sidebar) for cls in part.CLASSES))
# what else there is to register
_PARTS = (translations, *_SETTINGS, presets, gallery, menus, handlers, overlay)


def register() -> None:
    """Add the classes, the settings and the menu entry; an error leaves nothing half done."""
    done = []
    translations.mark(_CLASSES)
    try:
        for cls in _CLASSES:
            bpy.utils.register_class(cls)
            done.append(cls)
    except Exception:
        for cls in reversed(done):
            bpy.utils.unregister_class(cls)
        raise
    bpy.types.Scene.mobius_flow = PointerProperty(type=MobiusFlowSettings)
    for part in _PARTS:
        part.register()


def unregister() -> None:
    """Remove all of it; what is running ends first."""
    for part in reversed(_PARTS):
        part.unregister()
    del bpy.types.Scene.mobius_flow
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
