"""Values for options that tests know nothing of but their declaration."""

import math

from mobius_flow.core.base.arguments import Option


def unlike_default(option: Option) -> object:
    """An allowed value that is not the default, and is the same in 32 bits."""
    if option.kind is bool:
        return not option.default
    if option.repeated:
        return (("bending", 0.25),)
    if option.choices is not None:
        return next(name for name in reversed(list(option.choices)) if name != option.default)
    if option.kind is str:
        return option.example
    if math.isfinite(option.high):
        return option.kind(2.0 ** math.floor(math.log2(option.high)))
    value = option.kind(max(option.low, 0) + 2.5)
    return value if value != option.default else option.kind(value + 1)
