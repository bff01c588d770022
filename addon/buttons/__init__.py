"""What can be pressed: the operators, which check, act, and say what happened."""

from . import add_knot, baking, relaxing, running, shape

CLASSES = (*relaxing.CLASSES, *running.CLASSES, *baking.CLASSES, *shape.CLASSES, *add_knot.CLASSES)
