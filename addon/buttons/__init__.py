"""What can be pressed: the operators, which check, act, and say what happened."""

from . import add_knot, baking, outputs, relaxing, running, tube

CLASSES = (*relaxing.CLASSES, *running.CLASSES, *baking.CLASSES, *add_knot.CLASSES, *tube.CLASSES, *outputs.CLASSES)
