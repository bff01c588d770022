"""Where a value stands in a JSON text: Python's parser forgets the lines, and errors should name them."""

import re
from dataclasses import dataclass

Path = tuple[str | int, ...]  # keys and indices that lead from the top to a value

_TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|[\[\]{}:,]|[^\s\[\]{}:,"]+')


@dataclass
class _Level:
    """One open list or object, and the index or key of the value being read in it."""

    is_list: bool
    key: str | int


def line_of(text: str, path: Path) -> int | None:
    """Give the line (from 1) where the value at ``path`` starts in a valid JSON text; None if there is none."""
    levels: list[_Level] = []
    for match in _TOKEN.finditer(text):
        token = match.group()
        if token == ",":
            _next_item(levels[-1])
        elif token in "]}":
            levels.pop()
        elif token != ":":
            if _is_key(levels, text, match):
                levels[-1].key = token[1:-1]
                continue
            if tuple(level.key for level in levels) == path:
                return text.count("\n", 0, match.start()) + 1
            if token in "[{":
                levels.append(_Level(token == "[", 0 if token == "[" else ""))
    return None


def _next_item(level: _Level) -> None:
    if isinstance(level.key, int):
        level.key += 1


def _is_key(levels: list[_Level], text: str, match: re.Match[str]) -> bool:
    """Whether a token is the key of an object: a string followed by a colon."""
    in_object = bool(levels) and not levels[-1].is_list
    return in_object and match.group()[0] == '"' and text[match.end() :].lstrip().startswith(":")
