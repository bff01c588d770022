"""What can be pressed: the operators, which check, act, and say what happened."""

from . import add_knot, baking, relaxing, running

CLASSES = (*relaxing.CLASSES, *running.CLASSES, *baking.CLASSES, *add_knot.CLASSES)
