"""What can be pressed: the operators, which check, act, and say what happened."""

from . import add_knot, baking, relaxing, resting, running, shape

CLASSES = (
    *relaxing.CLASSES,
    *running.CLASSES,
    *baking.CLASSES,
    *shape.CLASSES,
    *resting.CLASSES,
    *add_knot.CLASSES,
)
