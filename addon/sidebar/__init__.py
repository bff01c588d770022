"""The sidebar's panels, each a module, and the entries in Blender's menus."""

from . import animation, expert, presets, relax

# presets go into the head of the panel; the sub-panels follow in the order they are shown
CLASSES = (
    *presets.CLASSES,
    *relax.CLASSES,
    *animation.CLASSES,
    *expert.CLASSES,
)
