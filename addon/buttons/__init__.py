"""What can be pressed: the operators, which check, act, and say what happened."""

from . import add_knot, baking, presets, relaxing, running, showing

CLASSES = (
    *relaxing.CLASSES,
    *running.CLASSES,
    *showing.CLASSES,
    *baking.CLASSES,
    *add_knot.CLASSES,
    *presets.CLASSES,
)
