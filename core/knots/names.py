"""Knots by name: one small grammar for the tables, torus knots, braids, mirror images, sums, hard unknots and arcs."""

import difflib
import re
from collections.abc import Mapping
from configparser import ConfigParser
from pathlib import Path

from ..base import CurveError, MobiusFlowError, checked
from ..curve import Curve
from .braids import Word, braid_closure, braid_diagram, checked_word, connected_sum, mirror, plat_diagram, torus_knot
from .diagrams import Diagram, PlanarCrossing, diagram_of, is_least, shuffled_down, simplified, views
from .diagrams.codes import check_count, diagram_from_code, is_code
from .formulas import FORMULAS
from .planar import drawn, refined

_LARGER = re.compile(r"(?P<kind>[kl]?)(?P<crossings>[1-9]\d?)_?(?P<sort>[an])_?0*(?P<number>[1-9]\d{0,5})", re.ASCII)
_OTHERWISE = 'give its code, such as "DT: [4 6 2]", "PD[X[1,5,2,4], ...]" or "Gauss: 1 -2 3 -1 2 -3"'


_TABLES = ConfigParser(delimiters="=", interpolation=None)
_TABLES.optionxform = str  # type: ignore[assignment,method-assign]  # names stay as they are written there
_TABLES.read_string(Path(__file__).with_name("table.ini").read_text(encoding="utf-8"))


def _word(letters: str) -> Word:
    return tuple(map(int, letters.split()))


KNOTS: Mapping[str, Word] = {name: _word(letters) for name, letters in _TABLES["braids"].items()}
"""Braid words of all prime knots to ten crossings and links to seven.

Handedness is the word's, positive letters being right-handed crossings: 3_1 is the right-handed trefoil.
"""

HARD_UNKNOTS: Mapping[str, tuple[PlanarCrossing, ...]] = {
    name: tuple(zip(*[iter(_word(edges))] * 4, strict=True)) for name, edges in _TABLES["hard unknots"].items()
}
"""Planar diagram codes of famous unknots that are hard to untangle, from 10 to 141 crossings."""

AMPHICHEIRAL = frozenset(" ".join(_TABLES["amphicheiral"].values()).split())
"""The knots that are their own mirror images, whatever their orientation, and such links."""

ROLFSEN: Mapping[str, str] = dict(_TABLES["rolfsen"])
"""Names of links in D. Rolfsen's table (*Knots and Links*, 1976): crossings, components, number."""

ALIASES: Mapping[str, str] = dict(_TABLES["other names"])
"""Other names for knots and links of the table, and for sums of them."""


def larger_word(kind: str, crossings: str, sort: str, number: str) -> Word:
    """A braid word from spherogram for a Hoste-Thistlethwaite name, such as K11n34 or ``11n_34``, in four parts.

    It is of the mirror image that spherogram chooses.  Raises MobiusFlowError if there is none, or no table.
    """
    name = f"{(kind or 'k').upper()}{crossings}{sort}{number}"
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


_TORUS = re.compile(r"(?:t|torus)\((?P<numbers>[^()#]*)(?P<end>\)?)")
_BRAID = re.compile(  # braid(1,1), {1,1} as in KnotInfo, BR[2,{1,1}] as in the Knot Atlas
    r"(?:braid\(|\{|br[\[(](?:(?P<strands>\d{1,9}),)?[\[({])(?P<numbers>[^\[\](){}#]*)(?P<end>[\])}]{0,2})"
)
_PLAT = re.compile(r"plat\((?P<numbers>[^()#]*)(?P<end>\)?)")
_NUMBER = re.compile(r"[+-]?\d{1,18}", re.ASCII)
_FORMS = "write T(p,q) or braid(1,-2,...)"
_HARD = {name.replace("-", ""): name for name in HARD_UNKNOTS}
_BY_ITSELF = {name.replace("-", ""): make for name, make in FORMULAS.items()}
_TABLE = {name.lower(): name for name in KNOTS}
_WORDS = {**ALIASES, **ROLFSEN}


class UnknownKnotError(MobiusFlowError):
    """A name that is not known; the message says which part of it is wrong, or suggests close names."""


def knot_names() -> list[str]:
    """Names of the table's knots and links, other names for them, the hard unknots, and curves from formulas."""
    return [*KNOTS, *(name.replace(" ", "-") for name in ALIASES), *HARD_UNKNOTS, *FORMULAS]


@checked
def knot(name: str, vertices: int | None = None) -> Curve:
    """Make a knot or link from its name, in any spelling.

    Names: the table's (``3_1`` to ``10_165``, ``L5a1``, also ``5^2_1``), the words of :data:`ALIASES` (``trefoil``,
    ``figure-eight``), those of larger tables (``K11n34``, ``L10a100``) where spherogram is installed, torus knots
    ``T(2,5)`` or ``torus(2,5)``, braids ``braid(1,-2,1,-2)``, ``{1,-2,1,-2}`` or ``BR[3,{1,-2,1,-2}]``, mirror images
    ``m3_1``, and connected sums ``3_1#m3_1``; also, by themselves, plats of braids ``plat(2,2,-1,2)``, the diagrams of
    :data:`HARD_UNKNOTS` (``goeritz``), the curves of :data:`FORMULAS` (``overhand``, ``bowline``), and codes of
    diagrams (``DT: [4 6 2]``, ``PD[X[1,5,2,4],...]``, ``Gauss: 1 -2 3 -1 2 -3``, and lists in brackets as SnapPy and
    KnotInfo have them).

    ``vertices`` is the total number; by default edges are shorter than strands are apart.  Raises UnknownKnotError for
    other names, and CurveError if the vertices are too few or a number is not allowed.

    >>> knot("T(2,4)", 100).mesh.component_sizes
    (50, 50)
    """
    name = re.sub(r"(?<=\d)(\(0,0\))+$", "", str(name))  # SnapPy prints the fillings of manifolds
    squeezed = _squeezed(name)
    if (torus := _TORUS.fullmatch(squeezed)) is not None:
        return torus_knot(*_torus(torus, name), vertices)
    if (braid := _BRAID.fullmatch(squeezed)) is not None:
        word, strands = _braid(braid, name)
        return braid_closure(word, vertices, strands=strands)
    if (by_itself := _joined(name)) in _BY_ITSELF:
        return _BY_ITSELF[by_itself](vertices)
    if (diagram := _own_diagram(name)) is not None:
        return refined(drawn(diagram), vertices)
    return braid_closure(braid_word(name), vertices)


@checked
def named_diagram(name: str) -> Diagram | None:
    """The diagram of a name in the grammar of :func:`knot`; None for curves from formulas.

    Codes, plats, braids and hard unknots are diagrams themselves; others have as few crossings as are found, which for
    knots of the table are fewest.  Raises as `knot` does.
    """
    if _joined(name) in _BY_ITSELF:
        return None
    if (own := _own_diagram(name)) is not None:
        return own
    closure = braid_diagram(word := braid_word(name))
    if _BRAID.fullmatch(_squeezed(name)):
        return closure
    bare, _ = _unmirrored(_plain(name))
    entry = _TABLE.get(_squeezed(_WORDS.get(bare, bare)), "")
    least = int(re.findall(r"\d+", entry)[0]) if entry else 0

    def is_enough(diagram: Diagram) -> bool:
        return is_least(diagram) or diagram.crossings <= least

    best = shuffled_down(simplified(closure), is_enough)
    if not is_enough(best) and entry:  # another beginning leads on
        found = (shuffled_down(simplified(view), is_enough) for view in views(braid_closure(word), 12))
        best = next(filter(is_enough, found), best)
    return best


def table_range(word: str) -> list[str]:
    """The names from one to another in the order of the table, ``3_1..8_21``; raises MobiusFlowError."""
    table = list(KNOTS)
    first, last = (table_name(end) for end in word.split("..", 1))
    low, high = table.index(first[0]), table.index(last[0])
    if first[1] or last[1]:
        raise MobiusFlowError(f"{word}: the table has no mirror images; name them one by one")
    if low > high:
        raise MobiusFlowError(f"{word}: {last[0]} comes before {first[0]} in the table; swap them")
    return table[low : high + 1]


def _own_diagram(name: str) -> Diagram | None:
    """The diagram that a code, a plat or a hard unknot is; None for other names."""
    if (plat := _PLAT.fullmatch(_squeezed(name))) is not None:
        check_count(len(word := _numbers(plat, name)))
        return plat_diagram(word)
    if is_code(name) and "#" not in name and not _BRAID.fullmatch(_squeezed(name)):
        return diagram_from_code(name)
    return diagram_of(HARD_UNKNOTS[_HARD[_joined(name)]]) if _joined(name) in _HARD else None


def table_name(name: str) -> tuple[str, bool]:
    """The table's name of a knot or link in it, and whether its mirror image is meant; raises as `knot` does."""
    part = _plain(str(name))
    bare, mirrored = _unmirrored(part)
    if (found := _TABLE.get(_squeezed(_WORDS.get(bare, bare)))) is None:
        knot(name)  # which says what is wrong with unknown names
        raise UnknownKnotError(f"{name[:60]!r} is a knot, but none of the table; give one of those, or m and one")
    return found, mirrored


@checked
def braid_word(name: str) -> Word:
    """Braid word of a name in the grammar of :func:`knot`; raises as `knot` does."""
    word: Word = ()
    for part in _plain(name).split("#"):
        word = connected_sum(word, _prime_word(part.strip(), name))
    return word


def _prime_word(part: str, name: str) -> Word:
    """The word of a summand of a name."""
    squeezed = _squeezed(part)
    if (torus := _TORUS.fullmatch(squeezed)) is not None:
        p, q = sorted(_torus(torus, name), key=abs)  # (σ₁ … σ_{p−1})^q
        if p * q == 0 or abs(p * q) > 10_000:
            given = "T({},{})".format(*_torus(torus, name))
            raise CurveError(f"{given} in a sum or mirror image needs p and q that are not 0, and |pq| ≤ 10000")
        word = tuple(range(1, abs(p))) * abs(q)
        return word if p * q > 0 else mirror(word)
    if (braid := _BRAID.fullmatch(squeezed)) is not None:
        word, strands = _braid(braid, name)
        if checked_word(word, strands)[1] > checked_word(word)[1]:
            raise UnknownKnotError(f"{part[:60]!r} in {name[:60]!r} has strands without letters; leave them out")
        return word
    if part in _WORDS:
        return braid_word(_WORDS[part])
    if squeezed in _TABLE:
        return KNOTS[_TABLE[squeezed]]
    if (larger := _LARGER.fullmatch(squeezed)) is not None:
        return larger_word(*larger.groups())
    bare, mirrored = _unmirrored(part)
    if bare in ("", part):
        plain = _plain(name)
        alike = [key for key in _TABLE if "_" in plain and key.startswith(plain.partition("_")[0] + "_")]
        close = difflib.get_close_matches(plain, alike or [*_TABLE, *ALIASES, *HARD_UNKNOTS], n=3, cutoff=0.5)
        advice = f"did you mean {' or '.join(_TABLE.get(c, c) for c in close)}? " if close else ""
        raise UnknownKnotError(
            f"no knot is called {name[:60]!r}; {advice}known are 0_1 to 10_165, links such as L2a1, words such as "
            "trefoil or goeritz, T(p,q), braid(1,-2,...), m before a name for the mirror image, and sums A#B"
        )
    word = _prime_word(bare, name)
    return mirror(word) if mirrored else word


def _unmirrored(part: str) -> tuple[str, bool]:
    """A name without its leading letters m, with which no bare name begins, and whether their number is odd."""
    bare = part.lstrip("m ") if part.startswith("m") else part
    return bare, part[: len(part) - len(bare)].count("m") % 2 == 1


def _numbers(match: re.Match[str], name: str) -> Word:
    if not match["end"]:
        raise UnknownKnotError(f"{name[:60]!r} has no closing bracket; {_FORMS}")
    numbers = match["numbers"].split(",") if match["numbers"] else []
    for number in numbers:
        if not _NUMBER.fullmatch(number):
            told = f"{number[:30]!r} in {name[:60]!r} is not a whole number of up to 18 digits; {_FORMS}"
            raise UnknownKnotError(told)
    return tuple(map(int, numbers))


def _torus(match: re.Match[str], name: str) -> tuple[int, int]:
    numbers = _numbers(match, name)
    if len(numbers) != 2:
        raise UnknownKnotError(f"{name[:60]!r} does not have two numbers; write T(p,q), such as T(2,5)")
    return numbers[0], numbers[1]


def _braid(match: re.Match[str], name: str) -> tuple[Word, int | None]:
    """The letters and, where it is given, the number of strands."""
    word = _numbers(match, name)
    if word and match[0].startswith("{") and sorted(word) == sorted({side * abs(k) for k in word for side in (1, -1)}):
        raise UnknownKnotError(f"{name[:60]!r} may be a braid or a Gauss code; write braid(...) or Gauss: ...")
    return word, int(match["strands"]) if match.groupdict()["strands"] else None


def _joined(name: str) -> str:
    return re.sub(r"[\s_-]", "", _plain(name))


def _squeezed(text: str) -> str:
    return re.sub(r"\s", "", text.lower())


def _plain(name: str) -> str:
    """Lower case, single spaces for spaces and hyphens between letters, no last word "knot", "unknot" or "link"."""
    text = re.sub(r"(?<=[a-z])[\s_-]+(?=[a-z])", " ", name.strip().lower())
    return re.sub(r"\s+(knot|unknot|link|rings)$", "", re.sub(r"\s+", " ", text))
