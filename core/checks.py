"""Values that are checked when they are made: an OptionError names the value and what is allowed."""

import math
from typing import Any

from .errors import OptionError


def check_fields(owner: Any, **intervals: tuple[float, float]) -> None:
    """Raise unless each named field of an object is finite and in its interval, whose lower end is left out."""
    for name, (low, high) in intervals.items():
        value = getattr(owner, name)
        if not (math.isfinite(value) and low < value <= high):
            allowed = f"above {low:g}" if math.isinf(high) else f"above {low:g} and at most {high:g}"
            raise OptionError(f"{name} is {value}; it must be a finite number {allowed}")
