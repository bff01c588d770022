"""What can be pressed: the operators, which check, act, and say what happened."""

from . import add_family, add_knot, baking, draw_knot, gallery, pick_knot, relaxing, running

CLASSES = (
    *relaxing.CLASSES,
    *running.CLASSES,
    *baking.CLASSES,
    *add_knot.CLASSES,
    *pick_knot.CLASSES,
    *add_family.CLASSES,
    *draw_knot.CLASSES,
    *gallery.CLASSES,
)
