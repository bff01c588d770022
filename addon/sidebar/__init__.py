"""The sidebar's panels, each a module, and the entries in Blender's menus."""

from . import advanced, animation, menus, relax

# the sub-panels in the order they are shown
CLASSES = (*menus.CLASSES, *relax.CLASSES, *animation.CLASSES, *advanced.CLASSES)
