"""The sidebar's panels, each a module, and the entries in Blender's menus."""

from . import advanced, animation, relax, tube

# sub-panels in the order they are shown
CLASSES = (*relax.CLASSES, *animation.CLASSES, *tube.CLASSES, *advanced.CLASSES)
