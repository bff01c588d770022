"""The sidebar's panels, each a module, and the entries in Blender's menus."""

from . import advanced, animation, knots, relax

CLASSES = (
    *relax.CLASSES,
    *knots.CLASSES,
    *animation.CLASSES,
    *advanced.CLASSES,
)  # sub-panels in the order they are shown
