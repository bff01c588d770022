"""What can be pressed: the operators, which check, act, and say what happened."""

from . import add_knot, baking, outputs, presets, relaxing, running, shape, showing, tube

_MODULES = (relaxing, running, showing, baking, shape, add_knot, tube, outputs, presets)
CLASSES = tuple(cls for module in _MODULES for cls in module.CLASSES)
