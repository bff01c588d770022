"""The named table: braid words of all prime knots to ten crossings, and of some links; codes of hard unknots.

Handedness is the braid word's, positive letters being right-handed crossings: 3_1 is the right-handed trefoil.
"""

from collections.abc import Iterator, Mapping
from types import MappingProxyType

from . import hard_codes, words_8, words_9, words_10
from .braids import Word
from .planar import Crossing

_LINKS: dict[str, Word] = {
    "L2a1": (1, 1),
    "L4a1": (1, 1, 1, 1),
    "L5a1": (1, -2, 1, -2, -2),
    "L6a3": (1, 1, 1, 1, 1, 1),
    "L6a4": (1, -2, 1, -2, 1, -2),
    "L6n1": (1, 2, 1, 2, 1, 2),
}


def _entries(text: str) -> Iterator[tuple[str, Word]]:
    for line in text.split("\n"):
        if line:
            name, *letters = line.split()
            yield name, tuple(map(int, letters))


KNOTS: Mapping[str, Word] = MappingProxyType(
    {
        **{name: word for module in (words_8, words_9, words_10) for name, word in _entries(module.WORDS)},
        **_LINKS,
    }
)


def _codes(text: str) -> Iterator[tuple[str, tuple[Crossing, ...]]]:
    for paragraph in text.strip().split("\n\n"):
        name, *edges = paragraph.split()
        numbers = iter(map(int, edges))
        yield name, tuple(zip(numbers, numbers, numbers, numbers, strict=True))


HARD_UNKNOTS: Mapping[str, tuple[Crossing, ...]] = MappingProxyType(dict(_codes(hard_codes.CODES)))
"""Planar diagram codes of famous unknots that are hard to untangle, from 10 to 141 crossings."""

ALIASES: Mapping[str, str] = MappingProxyType(
    {
        "unknot": "0_1",
        "circle": "0_1",
        "trefoil": "3_1",
        "figure eight": "4_1",
        "cinquefoil": "5_1",
        "stevedore": "6_1",
        "septafoil": "7_1",
        "perko": "10_161",
        "hopf": "L2a1",
        "solomon": "L4a1",
        "whitehead": "L5a1",
        "borromean": "L6a4",
        "granny": "3_1#3_1",
        "square": "3_1#m3_1",
    }
)
