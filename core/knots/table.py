"""The named table: braid words of all prime knots to ten crossings and links to seven; codes of hard unknots.

Handedness is the braid word's, positive letters being right-handed crossings: 3_1 is the right-handed trefoil.
"""

from collections.abc import Iterator, Mapping
from types import MappingProxyType

from ..diagrams import PlanarCrossing as Crossing
from . import hard_codes, words_8, words_9, words_10
from .braids import Word

_LINKS: dict[str, Word] = {
    "L2a1": (1, 1),
    "L4a1": (1, 1, 1, 1),
    "L5a1": (1, -2, 1, -2, -2),
    "L6a1": (1, -2, -1, -1, -1, -2, -2),
    "L6a2": (1, 1, 1, 1, 2, -1, 2),
    "L6a3": (1, 1, 1, 1, 1, 1),
    "L6a4": (1, -2, 1, -2, 1, -2),
    "L6a5": (1, -2, -2, 1, -2, -2),
    "L6n1": (1, 2, 1, 2, 1, 2),
    "L7a1": (1, -2, 1, -2, 1, -2, -2),
    "L7a2": (1, 1, -2, -2, 1, -2, -2),
    "L7a3": (1, -2, -2, 1, -2, -2, -2),
    "L7a4": (1, 2, -3, -2, 1, -2, -2, -3),
    "L7a5": (1, 1, -2, 1, -2, -2, -2),
    "L7a6": (1, -2, 1, -2, -2, -2, -2),
    "L7a7": (1, -2, -2, -1, -1, -1, -2, -2),
    "L7n1": (1, 1, 1, 2, 1, 1, 2),
    "L7n2": (1, 1, 1, 2, -1, -1, 2),
}

ROLFSEN: Mapping[str, str] = MappingProxyType(
    {
        "2^2_1": "L2a1",
        "4^2_1": "L4a1",
        "5^2_1": "L5a1",
        "6^2_1": "L6a3",
        "6^2_2": "L6a2",
        "6^2_3": "L6a1",
        "6^3_1": "L6a5",
        "6^3_2": "L6a4",
        "6^3_3": "L6n1",
        "7^2_1": "L7a6",
        "7^2_2": "L7a5",
        "7^2_3": "L7a4",
        "7^2_4": "L7a3",
        "7^2_5": "L7a2",
        "7^2_6": "L7a1",
        "7^2_7": "L7n1",
        "7^2_8": "L7n2",
        "7^3_1": "L7a7",
    }
)
"""Names of links in D. Rolfsen's table (*Knots and Links*, 1976): crossings, components, number."""


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
