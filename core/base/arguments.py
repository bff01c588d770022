"""Arguments and fields held against annotations and bounds: a wrong one is one clear sentence wherever it is given.

Options are declared once: a dataclass's field carries what people read of it and which values it takes. From that
follow its checks, the arguments of the command line, and Blender's settings and panels.
"""

import math
import os
import types
from collections.abc import Callable, Collection, Generator, Iterable, Mapping, Sequence
from dataclasses import MISSING, dataclass, field, fields, is_dataclass
from functools import cache, wraps
from inspect import cleandoc, signature
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
                is_short = isinstance(value, str | int | float | complex | tuple | None)
                told = shown(value) if is_short else f"of type {type(value).__name__}"
                raise MobiusFlowError(f"{name} is {told}; give {_wanted(hints[name])}")
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


_hints = cache(get_type_hints)


@cache
def _parts(hint: Any) -> tuple[Any, tuple[Any, ...]]:
    """Its origin, or the hint itself, and what is in brackets; aliases, such as NDArray from NumPy 2.5 on, resolved."""
    hint = getattr(get_origin(hint) or hint, "__value__", hint)
    return get_origin(hint) or hint, get_args(hint)


def _fits(value: Any, hint: Any) -> bool:
    kind, inner = _parts(hint)
    if kind in (Union, types.UnionType):
        return any(_fits(value, each) for each in inner)
    if kind is Callable:
        return callable(value)
    if kind in (tuple, list, Sequence) and inner:
        if not is_list(value):
            return False
        wanted = inner if kind is tuple and ... not in inner else inner[:1] * len(value)
        return len(value) == len(wanted) and all(map(_fits, value, wanted))
    if kind in _PLAIN:
        return is_plain(value, kind) and not (isinstance(value, Integral) and abs(int(value)) >= _BELOW[kind])
    if not isinstance(kind, type) or kind.__module__ == "typing" or getattr(kind, "_is_protocol", False):
        at_run_time = getattr(kind, "_is_runtime_protocol", False)
        return not at_run_time or (isinstance(value, kind) and not isinstance(value, type))
    return isinstance(value, kind)


def _wanted(hint: Any) -> str:
    kind, inner = _parts(hint)
    if kind in (Union, types.UnionType):
        return " or ".join(dict.fromkeys(map(_wanted, inner)))
    if kind in (tuple, list, Sequence) and inner:
        count = f" of {len(inner)}" if kind is tuple and ... not in inner else ""
        return f"{WORDS.get(kind, 'a list')}{count}, each {_wanted(inner[0])}"
    name = getattr(kind, "__name__", str(kind))
    return WORDS.get(kind) or f"{'an' if name[0] in 'AEIO' else 'a'} {name}"


@dataclass(frozen=True, kw_only=True)
class Option:
    """What there is to say of an option."""

    # name, kind, default: name, type and default of the field; where the default is None, None is allowed
    name: str
    kind: type
    default: Any
    label: str  # its title in a window
    help: str  # what it does: a phrase with neither a capital at its start nor a full stop
    automatic: str = ""  # what None means, where it is allowed
    # low, high: bounds of a number; a float is to be finite, and above its lower one
    low: float = -math.inf
    high: float = math.inf
    choices: Collection[str] | None = field(default=None, repr=False)  # the names it takes: a registry, or a few words
    # what else than a name a script may give: what it is called, and whether a value is one
    objects: tuple[str, Callable[[object], bool]] | None = field(default=None, repr=False)
    # the items of a tuple that a word of the command line gives, where it may be repeated
    read: Callable[[str], Iterable[object]] = field(default=str, repr=False)
    metavar: str = ""  # placeholder of its value in the command line's help, if not N, X or NAME
    row: bool = False  # whether Blender's panel shows it, as what artists might set; scripts can set them all
    repeated: bool = False  # whether its value is a tuple, whose items are checked; Blender has no settings for those
    flag: str = ""  # what it is called on the command line, if not by its name
    example: str = ""  # a tuple that is allowed, for messages, or a word

    @property
    def phrase(self) -> str:
        """The help; with the names, where any number of items may be named."""
        return f"{self.help}; by name: {', '.join(self.choices)}" if self.repeated and self.choices else self.help

    def sentence(self, none: str = "") -> str:
        """The help by itself, without a full stop; ``none`` is how None, if it is allowed, is written."""
        return self.help[0].upper() + self.help[1:] + (f"; {none}: {self.automatic}" if none and self.automatic else "")

    def checked(self, value: Any) -> Any:
        """The value, NumPy's numbers as Python's; an OptionError says what is allowed if the option cannot have it."""
        if self.repeated and is_list(value):
            return tuple(map(self._checked, value))
        if self.repeated:
            raise OptionError(f"{self.name} is {shown(value)}; it must be a tuple, such as {self.example}")
        return None if value is None and self.default is None else self._checked(value)

    def _checked(self, value: Any) -> Any:
        noun = "a name" if self.kind is str else WORDS.get(self.kind, "")
        if self.objects is not None:
            if self.objects[1](value):
                return value
            noun = f"{noun} or {self.objects[0]}" if noun else self.objects[0]
        if not is_plain(value, self.kind):
            raise OptionError(f"{self.name} is {shown(value)}; it must be {noun}")
        if self.kind in (int, float):
            try:
                float(value)
            except OverflowError:
                raise OptionError(f"{self.name} is too large for a number of this program") from None
            if self.kind is float:
                check_number(self.name, value, self.low, self.high)
            elif not self.low <= value <= self.high:
                allowed = f"{self.low} or more" if math.isinf(self.high) else f"from {self.low} to {self.high}"
                raise OptionError(f"{self.name} is {shown(value)}; it must be {allowed}")
        elif self.choices is not None:
            check_known(self.name, str(value), self.choices)
        return self.kind(value)


def option(default: Any, label: str, help: str, **more: Any) -> Any:
    """A field with its default and the other attributes of its `Option`."""
    return field(default=default, metadata={"label": label, "help": help, **more})


def declared(owner: type) -> list[Option]:
    hints = get_type_hints(owner)
    found = []
    for each in fields(owner):
        hint = hints[each.name]  # int, int | None or tuple[int, ...]: the kind is int
        kind, repeated = (get_args(hint) or (hint,))[0], get_origin(hint) is tuple
        found.append(Option(name=each.name, default=each.default, kind=kind, repeated=repeated, **each.metadata))
    return found


def check_options(owner: Any) -> None:
    """Let a frozen dataclass's options be as `Option.checked` gives them, when it is made."""
    for each in declared(type(owner)):
        object.__setattr__(owner, each.name, each.checked(getattr(owner, each.name)))


def documented(owner: _Class) -> _Class:
    """Put the options into a dataclass's docstring."""
    entries = [f"{each.name}\n    {each.sentence('None')}.\n" for each in declared(owner)]
    before, raises, after = cleandoc(str(owner.__doc__)).partition("Raises\n")
    owner.__doc__ = f"{before}Parameters\n----------\n{''.join(entries)}\n{raises}{after}"
    return owner
