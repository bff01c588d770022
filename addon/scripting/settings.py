"""Settings as scripts give them: by name, only those that matter, and values of any kind until they are checked."""

import numbers
from collections.abc import Collection, Mapping
from typing import Any

from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

from ...core import OptionError
from ...core.errors import choice, likeliest
from ..engine.timing import Pace
from ..properties import settings

_DECLARED = {name: (each.function, each.keywords) for name, each in settings(set()).items()}
_DEFAULTS = {name: keywords["default"] for name, (_, keywords) in _DECLARED.items()}
_KINDS: dict[Any, tuple[type, str]] = {
    BoolProperty: (bool, "True or False"),
    IntProperty: (numbers.Integral, "a whole number"),
    FloatProperty: (numbers.Real, "a number"),
    EnumProperty: (str, "a name"),
}


def implied(given: Collection[str]) -> dict[str, Any]:
    """What follows from which settings are given: frames for an iterate mean that, and a fit is one of any tube."""
    by_iterate = "frames_per_iterate" in given and "timing" not in given
    return ({"timing": Pace.ITERATE.name} if by_iterate else {}) | {"any_bevel": "fit_bevel" in given}


def complete(given: Mapping[str, Any]) -> dict[str, Any]:
    """All settings, with defaults for those that are not given.

    Raises
    ------
    OptionError
        If there is no setting of a name, or a value is none that it may have.
    """
    for name, value in given.items():
        if name not in ("any_bevel", "pins"):
            _check(name, value)
    return {**_DEFAULTS, **implied(given), **given}


def _check(name: str, value: Any) -> None:
    if name not in _DECLARED:
        raise OptionError(f"there is no setting {name!r}; {likeliest(name, _DECLARED)}see curve.mobius_flow_relax")
    function, keywords = _DECLARED[name]
    kind, words = _KINDS[function]
    if not isinstance(value, kind):
        raise OptionError(f"{name} is {value!r}; it must be {words}")
    if function is EnumProperty:
        names = [item[0] for item in keywords["items"] if item[0]]
        if value not in names:
            raise OptionError(f"{name} is {value!r}; {choice(str(value), names)}")
