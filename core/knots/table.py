"""The named table, read from ``table.ini``, and larger tables, which spherogram has where it is installed."""

import re
from collections.abc import Mapping
from configparser import ConfigParser
from pathlib import Path

from ..diagrams import PlanarCrossing
from ..errors import MobiusFlowError
from .braids import Word

FILE = Path(__file__).with_name("table.ini")
_LARGER = re.compile(r"(?P<kind>[kl]?)(?P<crossings>[1-9]\d?)_?(?P<sort>[an])_?0*(?P<number>[1-9]\d{0,5})", re.ASCII)
_OTHERWISE = 'give its code, such as "DT: [4 6 2]", "PD[X[1,5,2,4], ...]" or "Gauss: 1 -2 3 -1 2 -3"'


_FILE = ConfigParser(delimiters="=", interpolation=None)
_FILE.optionxform = str  # type: ignore[assignment,method-assign]  # names stay as they are written there
_FILE.read_string(FILE.read_text(encoding="utf-8"))


def _word(letters: str) -> Word:
    return tuple(map(int, letters.split()))


KNOTS: Mapping[str, Word] = {name: _word(letters) for name, letters in _FILE["braids"].items()}
"""Braid words of all prime knots to ten crossings and links to seven.

Handedness is the word's, positive letters being right-handed crossings: 3_1 is the right-handed trefoil.
"""

HARD_UNKNOTS: Mapping[str, tuple[PlanarCrossing, ...]] = {
    name: tuple(zip(*[iter(_word(edges))] * 4, strict=True)) for name, edges in _FILE["hard unknots"].items()
}
"""Planar diagram codes of famous unknots that are hard to untangle, from 10 to 141 crossings."""

AMPHICHEIRAL = frozenset(" ".join(_FILE["amphicheiral"].values()).split())
"""The knots that are their own mirror images, whatever their orientation, and such links."""

ROLFSEN: Mapping[str, str] = dict(_FILE["rolfsen"])
"""Names of links in D. Rolfsen's table (*Knots and Links*, 1976): crossings, components, number."""

ALIASES: Mapping[str, str] = dict(_FILE["other names"])
"""Other names for knots and links of the table, and for sums of them."""


def larger_name(name: str) -> str | None:
    """The Hoste-Thistlethwaite name, such as K11n34, of one in small letters (``11n_34``); None for other names."""
    match = _LARGER.fullmatch(name)
    if match is None:
        return None
    kind, crossings, sort, number = match.groups()
    return f"{(kind or 'k').upper()}{crossings}{sort}{number}"


def larger_word(name: str) -> Word:
    """A braid word from spherogram, of the mirror image it chooses; MobiusFlowError if there is none, or no table."""
    try:
        from spherogram import Link
    except ImportError as error:
        advice = f'try pip install spherogram (the extra "knots"), or {_OTHERWISE}'
        raise MobiusFlowError(f"{name} is in larger tables than the one here; {advice}") from error
    try:
        link = Link(name)
    except ValueError as error:
        raise MobiusFlowError(f"no knot or link is called {name} in spherogram's tables; {_OTHERWISE}") from error
    return tuple(map(int, link.braid_word()))
