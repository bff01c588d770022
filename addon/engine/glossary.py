"""Sentences of the core in Blender's words: splines, points and segments, where it has components and so on."""

import re
from collections.abc import Sequence

_WORDS = {
    "component": "spline",
    "components": "splines",
    "vertex": "point",
    "vertices": "points",
    "edge": "segment",
    "edges": "segments",
}
_TERM = re.compile(rf"\bcomponent (\d+)\b|\b({'|'.join(_WORDS)})\b")


def in_blenders_words(sentence: str, splines: Sequence[str]) -> str:
    """Say the same to somebody who sees curve objects; ``splines`` are the names of the components in turn."""
    return _TERM.sub(lambda match: splines[int(match[1]) - 1] if match[1] else _WORDS[match[2]], sentence)


def spline_names(objects: Sequence[str], counts: Sequence[int]) -> list[str]:
    """Names of all splines of some objects, of which each has so many."""
    return [f"spline {k} of '{name}'" for name, count in zip(objects, counts, strict=True) for k in range(1, count + 1)]
