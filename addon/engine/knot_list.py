"""The table's knots as artists pick them: labels with their names in words, in groups of not too many."""

from collections.abc import Mapping, Sequence
from functools import cache
from types import MappingProxyType

from ...core.knots import ALIASES, KNOTS

COMMON: Sequence[str] = ("0_1", "3_1", "4_1", "5_1", "5_2", "6_1", "7_4", "L2a1", "L4a1", "L5a1", "L6a4")
"""What most people look for."""

GROUPS: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        "FEW": ("Up to 7 Crossings", "Knots that can be drawn with seven crossings or fewer"),
        "8": ("8 Crossings", "Knots that need eight crossings"),
        "9": ("9 Crossings", "Knots that need nine crossings"),
        "10A": ("10 Crossings, I", "The first knots that need ten crossings"),
        "10B": ("10 Crossings, II", "The other knots that need ten crossings"),
        "LINKS": ("Links", "Several closed curves that hang together"),
    }
)
"""Titles and descriptions of the groups."""

_TITLES = {"solomon": "Solomon's Link", "hopf": "Hopf Link", "whitehead": "Whitehead Link", "perko": "Perko Pair"}
_TITLES |= {"borromean": "Borromean Rings", "figure eight": "Figure-Eight", "circle": ""}
_HALF = 83  # of the 165 knots with ten crossings


def group(name: str) -> str:
    """The group that a knot of the table is in."""
    crossings, _, number = name.partition("_")
    if not number:
        return "LINKS"
    if int(crossings) <= 7:
        return "FEW"
    return crossings if crossings != "10" else "10A" if int(number) <= _HALF else "10B"


@cache
def labels() -> Mapping[str, str]:
    """What each knot of the table is called in lists, such as ``3_1 Trefoil``."""
    words: dict[str, str] = {}
    for alias, name in ALIASES.items():
        if title := _TITLES.get(alias, alias.title()):
            words.setdefault(name, title)
    return MappingProxyType({name: f"{name} {words[name]}" if name in words else name for name in KNOTS})


def name_of(label: str) -> str:
    """The name that a label begins with; anything else is given back as it is."""
    first = label.split()[0] if label.split() else label
    return first if labels().get(first) == label.strip() else label
