"""Sentences of the core in Blender's words: splines, points and segments, where it has components and so on."""

import re
from collections.abc import Sequence
from string import Formatter

from ...core import Obstacle
from ...core.messages import Message

_WORDS = {
    "component": "spline",
    "components": "splines",
    "vertex": "point",
    "vertices": "points",
    "edge": "segment",
    "edges": "segments",
}
_TERM = rf"\bcomponent (\d+)\b|\b({'|'.join(_WORDS)})\b"

_ENDS = (  # how most relaxations end, see `core.driver.outcome`
    Message("converged: projected gradient {norm} ≤ {bound}"),
    Message("stopped after {count} iterations, as asked for"),
    Message("stopped after 1 iteration, as asked for"),
    Message("stopped at the time limit, {seconds} s, as asked for"),
)


def in_blenders_words(sentence: str, splines: Sequence[str], avoided: Sequence[Obstacle] = ()) -> str:
    """Say the same to somebody who sees objects; ``splines`` are the names of the components in turn."""
    names = {each.title: f"'{each.name}'" for each in avoided}
    titles = "|".join(re.escape(title) for title in sorted(names, key=len, reverse=True)) or "(?!)"

    def said(match: re.Match[str]) -> str:
        return splines[int(match[1]) - 1] if match[1] else names.get(match[0]) or _WORDS[match[2]]

    return re.sub(f"{_TERM}|{titles}", said, sentence)


def spline_names(objects: Sequence[str], counts: Sequence[int]) -> list[str]:
    """Names of all splines of some objects, of which each has so many."""
    return [f"spline {k} of '{name}'" for name, count in zip(objects, counts, strict=True) for k in range(1, count + 1)]


def as_phrase(sentence: str) -> str:
    """The core's sentence about how a relaxation ended as a phrase, if it is one that can be translated."""
    for end in _ENDS:
        if match := _pattern(end).fullmatch(sentence):
            return Message(end.template, **match.groupdict())
    return sentence


def _pattern(template: str) -> re.Pattern[str]:
    pieces = Formatter().parse(template)
    return re.compile(
        "".join(re.escape(text) + (f"(?P<{field}>[^;]+)" if field else "") for text, field, _, _ in pieces)
    )
