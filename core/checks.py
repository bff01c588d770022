"""Values that are checked when they are made: an OptionError names the value and what is allowed."""

import math
from collections.abc import Collection, Mapping
from typing import Any, TypeVar

from .errors import OptionError, choice

_Entry = TypeVar("_Entry")


def check_fields(owner: Any, **intervals: tuple[float, float]) -> None:
    """Raise unless each named field of an object is finite and in its interval, whose lower end is left out."""
    for name, interval in intervals.items():
        check_number(name, getattr(owner, name), *interval)


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


def named(table: Mapping[str, _Entry], kind: str, name: str) -> _Entry:
    """Look an entry of a registry up; an OptionError lists the known ones."""
    check_known(kind, name, table)
    return table[name]
