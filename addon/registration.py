"""Everything that Blender is told about at registration, and forgets at unregistration."""

from types import ModuleType

import bpy

from . import settings, translations
from .buttons import adding, drawing, film, mending, outputs, presets, relaxing, running, shape
from .live import handlers, overlay
from .sidebar import menus, panels

# presets go into the head of the panel; the sub-panels follow in the order they are shown
_MODULES = (relaxing, running, mending, shape, outputs, film, adding, drawing, presets, menus, panels)
# everything else to register
_PARTS = (translations, settings, presets, menus, handlers, overlay)


def declared(module: ModuleType) -> list[type]:
    """The classes for Blender that a module declares, in the order of their declaration; tools are none of them."""
    own = [each for each in vars(module).values() if isinstance(each, type) and each.__module__ == module.__name__]
    return [each for each in own if issubclass(each, bpy.types.bpy_struct) and each.__base__ != bpy.types.WorkSpaceTool]


CLASSES = (*settings.GROUPS_OF_SCENE.values(), *(cls for module in _MODULES for cls in declared(module)))


def register() -> None:
    """Add the classes, the settings and the menu entries; an error leaves nothing half done."""
    done = []
    translations.mark(CLASSES)
    try:
        for cls in CLASSES:
            bpy.utils.register_class(cls)
            done.append(cls)
    except Exception:
        for cls in reversed(done):
            bpy.utils.unregister_class(cls)
        raise
    for part in _PARTS:
        part.register()


def unregister() -> None:
    """Remove all of it, after ending what is running."""
    for part in reversed(_PARTS):
        part.unregister()
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
