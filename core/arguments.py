"""Arguments and fields held against annotations and bounds: a wrong one is one clear sentence wherever it is given."""

import math
import os
import types
from collections.abc import Callable, Collection, Generator, Mapping, Sequence
from dataclasses import MISSING, field, fields, is_dataclass
from functools import cache, wraps
from inspect import signature
from numbers import Integral, Real
from typing import Any, ParamSpec, TypeVar, Union, get_args, get_origin, get_type_hints

import numpy as np

from .errors import MobiusFlowError, OptionError, choice, shown

_Arguments = ParamSpec("_Arguments")
_Result = TypeVar("_Result")
_Class = TypeVar("_Class", bound=type)
_PLAIN: dict[Any, tuple[type, ...]] = {str: (str,), float: (Real,), int: (Integral,), bool: (bool, np.bool_)}
_BELOW = {float: 2**1023, int: 2**63, bool: 2}  # whole numbers that fit
WORDS: dict[Any, str] = {
    float: "a number",
    int: "a whole number",
    bool: "True or False",
    str: "a string",
    type(None): "None",
    Callable: "a function",
    Sequence: "a list",
    tuple: "a tuple",
    Mapping: "a dictionary",
    Generator: "a generator, such as relax gives",
    os.PathLike: "a path",
    np.ndarray: "an array",
}


def checked(function: Callable[_Arguments, _Result]) -> Callable[_Arguments, _Result]:
    """Raise a MobiusFlowError that names an argument not of its annotated type; contents of arrays are not checked."""
    parameters = signature(function)

    @wraps(function)
    def called(*args: _Arguments.args, **keywords: _Arguments.kwargs) -> _Result:
        try:
            given = parameters.bind(*args, **keywords).arguments
        except TypeError:
            return function(*args, **keywords)  # Python's own sentence names the function
        hints = _hints(function)
        for name, value in given.items():
            if name in hints and not _fits(value, hints[name]):
                raise MobiusFlowError(f"{name} is {_described(value)}; give {_wanted(hints[name])}")
        return function(*args, **keywords)

    return called


def checked_fields(owner: _Class) -> _Class:
    """Let a class do so when it is made; its fields that are a `number` are held against their bounds too."""
    given = checked(owner.__init__)  # type: ignore[misc]

    @wraps(given)
    def made(self: Any, *args: Any, **keywords: Any) -> None:
        given(self, *args, **keywords)
        for each in fields(self) if is_dataclass(self) else ():
            if "bounds" in each.metadata:
                check_number(each.name, getattr(self, each.name), *each.metadata["bounds"])

    owner.__init__ = made  # type: ignore[misc]
    return owner


def number(default: Any = MISSING, above: float = 0.0, most: float = math.inf) -> Any:
    """A field for a finite number in an interval, whose lower end is left out: an OptionError names what is not."""
    return field(default=default, metadata={"bounds": (above, most)})


def check_number(name: str, value: float, low: float, high: float) -> None:
    """Raise unless a number is finite and in an interval, whose lower end is left out."""
    if not (math.isfinite(value) and low < value <= high):
        allowed = f"above {low:g}" if math.isinf(high) else f"above {low:g} and at most {high:g}"
        raise OptionError(f"{name} is {value}; it must be a finite number {allowed}")


def check_known(name: str, value: str, known: Collection[str]) -> None:
    """Raise unless a value is a name in a registry, or one of a few words."""
    if value not in known:
        found = f"{name} {value!r:.60} is unknown" if isinstance(known, Mapping) else f"{name} is {value!r:.60}"
        raise OptionError(f"{found}; {choice(value, known)}")


def is_list(value: object) -> bool:
    """Whether a value has items in a row: a sequence, but no string, or an array."""
    if isinstance(value, np.ndarray):
        return value.ndim > 0
    return isinstance(value, Sequence) and not isinstance(value, str | bytes)


def is_plain(value: object, kind: object) -> bool:
    """Whether a value is of a plain type: NumPy's numbers count too, and truth values are no numbers."""
    return isinstance(value, _PLAIN.get(kind, ())) and isinstance(value, bool | np.bool_) == (kind is bool)


@cache
def _hints(function: Callable[..., object]) -> dict[str, Any]:
    return get_type_hints(function)


@cache
def _spelt_out(hint: Any) -> Any:
    """Resolve an alias, such as NDArray from NumPy 2.5 on."""
    return getattr(get_origin(hint) or hint, "__value__", hint)


def _fits(value: Any, hint: Any) -> bool:
    hint = _spelt_out(hint)
    origin, inner = get_origin(hint), get_args(hint)
    if origin in (Union, types.UnionType):
        return any(_fits(value, each) for each in inner)
    if origin is Callable:
        return callable(value)
    if origin in (tuple, list, Sequence):
        wanted = inner if _is_of_fixed_length(hint) or not is_list(value) else inner[:1] * len(value)
        return is_list(value) and len(value) == len(wanted) and all(map(_fits, value, wanted))
    kind = origin or hint
    if kind in _PLAIN:
        return is_plain(value, kind) and not (isinstance(value, Integral) and abs(int(value)) >= _BELOW[kind])
    if not isinstance(kind, type) or kind.__module__ == "typing" or getattr(kind, "_is_protocol", False):
        at_run_time = getattr(kind, "_is_runtime_protocol", False)
        return not at_run_time or (isinstance(value, kind) and not isinstance(value, type))
    return isinstance(value, kind)


def _is_of_fixed_length(hint: Any) -> bool:
    return get_origin(hint) is tuple and ... not in get_args(hint)


def _described(value: Any) -> str:
    """What is given: the value itself where that is short, or its type."""
    if isinstance(value, str | int | float | complex | tuple | None):
        return shown(value)
    return f"of type {type(value).__name__}"


def _wanted(hint: Any) -> str:
    hint = _spelt_out(hint)
    origin, inner = get_origin(hint), get_args(hint)
    if origin in (Union, types.UnionType):
        return " or ".join(dict.fromkeys(map(_wanted, inner)))
    kind = origin or hint
    if origin in (tuple, list, Sequence):
        count = f" of {len(inner)}" if _is_of_fixed_length(hint) else ""
        return f"{WORDS.get(kind, 'a list')}{count}, each {_wanted(inner[0])}"
    name = getattr(kind, "__name__", str(kind))
    return WORDS.get(kind) or f"{'an' if name[0] in 'AEIO' else 'a'} {name}"
