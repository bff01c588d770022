"""Names of objects in sentences."""

from collections.abc import Sequence

from ...core.messages import Message

_MAX_NAMES = 3


def named(names: Sequence[str]) -> str:
    """Join names, such as 'A', 'B' and 'C'; of many the first, and how many more there are."""
    if len(names) > _MAX_NAMES + 1:
        first, count = ", ".join(map(_quoted, names[:_MAX_NAMES])), len(names) - _MAX_NAMES
        return Message("{names} and {count} more", names=first, count=count)
    *others, last = map(_quoted, names)
    return Message("{names} and {last}", names=", ".join(others), last=last) if others else last


def _quoted(name: str) -> str:
    return f"'{name}'"
