"""Names of objects in sentences."""

from collections.abc import Sequence

_MAX_NAMES = 3


def named(names: Sequence[str]) -> str:
    """Join names, such as 'A', 'B' and 'C'; of many the first, and how many more there are."""
    if len(names) > _MAX_NAMES + 1:
        return f"{', '.join(map(_quoted, names[:_MAX_NAMES]))} and {len(names) - _MAX_NAMES} more"
    *first, last = map(_quoted, names)
    return f"{', '.join(first)} and {last}" if first else last


def _quoted(name: str) -> str:
    return f"'{name}'"
