"""Lists of numbers within brackets of any kind, as people write codes of diagrams; errors say at which character."""

import re
from collections.abc import Sequence
from typing import cast

from ..errors import CurveError

Nested = Sequence["int | str | Nested"]
_MAX_DIGITS = 9
_PLAIN = r"(?P<open>[\[({])|(?P<close>[\])}])|(?P<number>[+-]?\d+)|(?P<blank>[,;]|\s+)|(?P<other>[A-Za-z]+|.)"
_SIGNED = r"(?P<signed>[OU]\d{1,9}[+-])"


class CodeError(CurveError):
    """Something in a code that cannot be read, and where: ``position`` counts characters from 0."""

    def __init__(self, reason: str, position: int) -> None:
        super().__init__(f"character {position + 1} of the code: {reason}")
        self.position = position


def nested(text: str, between: str | None = None) -> Nested:
    """Whole numbers, between blanks, commas or semicolons, in lists for their brackets.

    ``between`` is a pattern of what ends one list and begins the next, like ``],[``, with brackets around it all;
    signed passes such as O1+ are then read like numbers, as strings.  Raises CodeError if there is anything else, or
    brackets do not match.
    """
    pattern = f"(?P<between>{between})|{_SIGNED}|{_PLAIN}" if between else _PLAIN
    stack: list[list[object]] = [[], []]
    opened: list[int] = []
    for match in re.finditer(pattern, text, re.ASCII | re.IGNORECASE | re.DOTALL):
        kind, token, at = match.lastgroup, match[0], match.start()
        if kind == "open":
            opened.append(at)
            stack.append([])
        elif kind == "close":
            if not opened:
                raise CodeError("a closing bracket too many", at)
            opened.pop()
            _close(stack)
        elif kind == "between":
            _close(stack, empty=at)
            stack.append([])
        elif kind == "signed":
            stack[-1].append(token.upper())
        elif kind == "number" and len(token) <= _MAX_DIGITS:
            stack[-1].append(int(token))
        elif kind != "blank":
            reason = f"{token[:30]!a} is neither a bracket nor a whole number of at most {_MAX_DIGITS} digits"
            raise CodeError(reason, at)
    if opened:
        raise CodeError("this bracket has no closing one", opened[-1])
    _close(stack, empty=len(text) - 1 if stack[0] else None)
    return cast(Nested, stack[0] if between else stack[0][0])


def _close(stack: list[list[object]], empty: int | None = None) -> None:
    done = stack.pop()
    if not done and empty is not None:
        raise CodeError("a component is empty; write [] for a circle that crosses nothing", empty)
    stack[-1].append(done)


def unwrapped(rows: Nested) -> Nested:
    """What is within brackets around it all."""
    while len(rows) == 1 and not isinstance(rows[0], int | str):
        if _is_flat(rows[0]) and rows[0]:
            return rows[0]
        rows = rows[0]
    return rows


def components(rows: Nested) -> list[list[int | str]]:
    """Lists without brackets, one for each component or crossing; raises CurveError for lists deeper down."""
    rows = unwrapped(rows)
    parts = [rows] if _is_flat(rows) else [[row] if isinstance(row, int | str) else unwrapped(row) for row in rows]
    if not all(map(_is_flat, parts)):
        raise CurveError("brackets of the code are not where they should be: write numbers, or lists of numbers")
    return [list(cast(Sequence[int | str], part)) for part in parts]


def _is_flat(rows: Nested) -> bool:
    return all(isinstance(each, int | str) for each in rows)
