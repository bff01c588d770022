"""What can be pressed: the operators, which check, act, and say what happened."""

from . import add_knot, baking, mending, relaxing, running

CLASSES = (*relaxing.CLASSES, *running.CLASSES, *baking.CLASSES, *mending.CLASSES, *add_knot.CLASSES)
