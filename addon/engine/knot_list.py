"""The table's knots as artists pick them: labels, and groups that are not too large."""

from collections.abc import Mapping, Sequence
from functools import cache
from types import MappingProxyType

from ...core.knots import ALIASES, KNOTS

COMMON: Sequence[str] = ("0_1", "3_1", "4_1", "5_1", "5_2", "6_1", "7_4", "L2a1", "L4a1", "L5a1", "L6a4")
"""What most people look for."""

GROUPS: Mapping[str, tuple[str, str]] = {
    "FEW": ("Up to 7 Crossings", "Knots that can be drawn with seven crossings or fewer"),
    "8": ("8 Crossings", "Knots that need eight crossings"),
    "9": ("9 Crossings", "Knots that need nine crossings"),
    "10A": ("10 Crossings, I", "The first knots that need ten crossings"),
    "10B": ("10 Crossings, II", "The other knots that need ten crossings"),
    "LINKS": ("Links", "Several closed curves, linked with each other"),
}
"""Titles and descriptions of the groups."""

_TITLES = {"solomon": "Solomon's Link", "hopf": "Hopf Link", "whitehead": "Whitehead Link", "perko": "Perko Pair"}
_TITLES |= {"borromean": "Borromean Rings", "figure eight": "Figure-Eight", "circle": ""}


def group(name: str) -> str:
    """The group that a knot of the table is in."""
    crossings, _, number = name.partition("_")
    if not number:
        return "LINKS"
    if int(crossings) <= 7:
        return "FEW"
    # half of the 165 knots with ten crossings
    return crossings if crossings != "10" else "10A" if int(number) <= 83 else "10B"


@cache
def labels() -> Mapping[str, str]:
    """The label of each knot of the table in lists, such as ``3_1 Trefoil``."""
    words: dict[str, str] = {}
    for alias, name in ALIASES.items():
        if title := _TITLES.get(alias, alias.title()):
            words.setdefault(name, title)
    return MappingProxyType({name: f"{name} {words[name]}" if name in words else name for name in KNOTS})


def name_of(label: str) -> str:
    """The name that a label begins with; anything else is returned unchanged."""
    first = label.split()[0] if label.split() else label
    return first if labels().get(first) == label.strip() else label
