"""Options declared once: a dataclass's field carries what people read of it and which values it takes.

From that follow its checks, the arguments of the command line, and Blender's settings and panels.
"""

import math
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, field, fields
from inspect import cleandoc
from typing import Any, TypeVar, get_args, get_origin, get_type_hints

from .arguments import WORDS, check_known, check_number, is_list, is_plain
from .errors import OptionError, shown

_Class = TypeVar("_Class", bound=type)


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
    metavar: str = "NAME"  # placeholder of its value in the command line's help
    row: bool = False  # whether Blender's panel shows it, as what artists might set; scripts can set them all
    # words of the command line, each with the choice it selects; one of them at most, or the option itself
    shorthands: Mapping[str, str] = field(default_factory=dict, repr=False)
    repeated: bool = False  # whether its value is a tuple, whose items are checked
    flag: str = ""  # what it is called on the command line, if not by its name
    example: str = ""  # a tuple that is allowed, for messages, or a word

    @property
    def is_setting(self) -> bool:
        """Whether it is among Blender's settings."""
        return not self.repeated

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
            self._check_number(value)
        elif self.choices is not None:
            check_known(self.name, str(value), self.choices)
        return self.kind(value)

    def _check_number(self, value: Any) -> None:
        try:
            float(value)
        except OverflowError:
            raise OptionError(f"{self.name} is too large for a number of this program") from None
        if self.kind is float:
            check_number(self.name, value, self.low, self.high)
        elif not self.low <= value <= self.high:
            allowed = f"{self.low} or more" if math.isinf(self.high) else f"from {self.low} to {self.high}"
            raise OptionError(f"{self.name} is {shown(value)}; it must be {allowed}")


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


def documented(owner: _Class) -> _Class:
    """Put the options into a dataclass's docstring."""
    entries = [f"{each.name}\n    {each.sentence('None')}.\n" for each in declared(owner)]
    before, raises, after = cleandoc(str(owner.__doc__)).partition("Raises\n")
    owner.__doc__ = f"{before}Parameters\n----------\n{''.join(entries)}\n{raises}{after}"
    return owner
