"""The named table, read from ``table.ini``: braid words of knots and links, codes of hard unknots, and other names."""

from collections.abc import Mapping
from configparser import ConfigParser
from pathlib import Path
from types import MappingProxyType

from ..diagrams import PlanarCrossing as Crossing
from .braids import Word

FILE = Path(__file__).with_name("table.ini")


def _file() -> ConfigParser:
    """The file, with names as they are written there."""
    parser = ConfigParser(delimiters="=", interpolation=None)
    parser.optionxform = str  # type: ignore[assignment,method-assign]
    parser.read_string(FILE.read_text(encoding="utf-8"))
    return parser


def _word(letters: str) -> Word:
    return tuple(map(int, letters.split()))


def _code(edges: str) -> tuple[Crossing, ...]:
    numbers = iter(_word(edges))
    return tuple(zip(numbers, numbers, numbers, numbers, strict=True))


_FILE = _file()

KNOTS: Mapping[str, Word] = MappingProxyType({name: _word(letters) for name, letters in _FILE["braids"].items()})
"""Braid words of all prime knots to ten crossings and links to seven.

Handedness is the word's, positive letters being right-handed crossings: 3_1 is the right-handed trefoil.
"""

HARD_UNKNOTS: Mapping[str, tuple[Crossing, ...]] = MappingProxyType(
    {name: _code(edges) for name, edges in _FILE["hard unknots"].items()}
)
"""Planar diagram codes of famous unknots that are hard to untangle, from 10 to 141 crossings."""

AMPHICHEIRAL = frozenset(" ".join(_FILE["amphicheiral"].values()).split())
"""The knots that are their own mirror images, whatever their orientation, and such links."""

ROLFSEN: Mapping[str, str] = MappingProxyType(dict(_FILE["rolfsen"]))
"""Names of links in D. Rolfsen's table (*Knots and Links*, 1976): crossings, components, number."""

ALIASES: Mapping[str, str] = MappingProxyType(dict(_FILE["other names"]))
"""Other names for knots and links of the table, and for sums of them."""
