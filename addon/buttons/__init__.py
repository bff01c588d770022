"""What can be pressed: the operators, which check, act, and say what happened."""

from . import (
    add_family,
    add_knot,
    baking,
    closing,
    draw_knot,
    film,
    gallery,
    mending,
    outputs,
    pick_knot,
    pinning,
    presets,
    relaxing,
    resting,
    running,
    shape,
    showing,
    tube,
)

_MODULES = (
    relaxing,
    running,
    showing,
    baking,
    mending,
    closing,
    pinning,
    shape,
    resting,
    tube,
    outputs,
    film,
    add_knot,
    pick_knot,
    add_family,
    draw_knot,
    gallery,
    presets,
)
CLASSES = tuple(cls for module in _MODULES for cls in module.CLASSES)
