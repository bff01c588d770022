"""The sidebar's panels, each a module, and the entries in Blender's menus."""

from . import animation, expert, film, knots, menus, pins, presets, relax, shape, surroundings, tube

# presets go into the head of the panel; the sub-panels follow in the order they are shown
_MODULES = (menus, presets, relax, knots, pins, surroundings, animation, shape, tube, film, expert)
CLASSES = tuple(cls for module in _MODULES for cls in module.CLASSES)
