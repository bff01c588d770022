"""Knots by name: one small grammar for the table, torus knots, braids, mirror images, sums and hard unknots."""

import difflib
import re

from ..curve import Curve
from ..errors import MobiusFlowError
from .braids import Word, connected_sum, mirror
from .closures import braid_closure
from .planar import diagram_knot
from .table import ALIASES, HARD_UNKNOTS, KNOTS
from .torus import torus_knot

_TORUS = re.compile(r"t(?:orus)?\(([+-]?\d{1,6}),([+-]?\d{1,6})\)", re.ASCII)
_BRAID = re.compile(r"braid\(((?:[+-]?\d{1,6}(?:,[+-]?\d{1,6})*)?)\)", re.ASCII)
_HARD = {name.replace("-", ""): name for name in HARD_UNKNOTS}
_TABLE = {name.lower(): name for name in KNOTS}


class UnknownKnotError(MobiusFlowError):
    """A knot name that means nothing; the message gives close names and the grammar."""

    def __init__(self, name: str) -> None:
        plain = _plain(name)
        alike = [key for key in _TABLE if "_" in plain and key.startswith(plain.partition("_")[0] + "_")]
        close = difflib.get_close_matches(plain, alike or [*_TABLE, *ALIASES, *HARD_UNKNOTS], n=3, cutoff=0.5)
        advice = f"did you mean {' or '.join(_TABLE.get(c, c) for c in close)}? " if close else ""
        super().__init__(
            f"no knot is called {name[:60]!r}; {advice}known are 0_1 to 10_165, the links "
            f"{', '.join(key for key in KNOTS if key[0] == 'L')}, the names {', '.join(ALIASES)}, "
            f"the hard unknots {', '.join(HARD_UNKNOTS)}, "
            "T(p,q), braid(1,-2,...), m before a name for the mirror image, and sums A#B"
        )


def knot(name: str, vertices: int | None = None) -> Curve:
    """Make a knot or link from its name.

    Names: the table's (``3_1`` to ``10_165``, ``L5a1``), the words of :data:`ALIASES` (``trefoil``,
    ``figure-eight``), torus knots ``T(2,5)`` or ``torus(2,5)``, braids ``braid(1,-2,1,-2)``, mirror images
    ``m3_1``, and connected sums ``3_1#m3_1``; also the diagrams of :data:`HARD_UNKNOTS` (``goeritz``), by themselves.
    Letter case, spaces, hyphens and a last word "knot", "unknot" or "link" don't matter.

    Parameters
    ----------
    name
        The name.
    vertices
        Total number of vertices; by default so many that edges are shorter than strands are apart.

    Raises
    ------
    UnknownKnotError
        If the name means nothing; the message lists close and known names.
    CurveError
        If the vertices are too few or a number is not allowed.

    Examples
    --------
    >>> len(knot("figure-eight knot", 80))
    80
    >>> knot("T(2,4)", 100).mesh.component_sizes
    (50, 50)
    """
    name = str(name)  # a number is no name either, and is told so
    hard = _HARD.get(_unspaced(_plain(name)))
    if hard is not None:
        return diagram_knot(HARD_UNKNOTS[hard], vertices)
    torus = _TORUS.fullmatch(_squeezed(name))
    if torus:
        return torus_knot(int(torus[1]), int(torus[2]), vertices)
    return braid_closure(braid_word(name), vertices)


def braid_word(name: str) -> Word:
    """Braid word of a name in the grammar of :func:`knot`; raises UnknownKnotError."""
    word: Word = ()
    for part in _plain(name).split("#"):
        word = connected_sum(word, _prime_word(part.strip(), name))
    return word


def _prime_word(part: str, name: str) -> Word:
    squeezed = _squeezed(part)
    torus, braid = _TORUS.fullmatch(squeezed), _BRAID.fullmatch(squeezed)
    if torus:
        return _torus_word(int(torus[1]), int(torus[2]), name)
    if braid:
        return tuple(int(letter) for letter in braid[1].split(",") if letter)
    if part in ALIASES:
        return braid_word(ALIASES[part])
    if squeezed in _TABLE:
        return KNOTS[_TABLE[squeezed]]
    if part.startswith("m") and len(part) > 1:
        return mirror(_prime_word(part[1:].strip(), name))
    raise UnknownKnotError(name)


def _torus_word(p: int, q: int, name: str) -> Word:
    """(σ₁ … σ_{p−1})^q, for torus knots within sums and mirror images."""
    p, q = sorted((p, q), key=abs)
    if p == 0 or abs(p * q) > 10_000:
        raise UnknownKnotError(name)
    word = tuple(range(1, abs(p))) * abs(q)
    return word if p * q > 0 else mirror(word)


def _squeezed(text: str) -> str:
    return re.sub(r"\s", "", text.lower())


def _unspaced(text: str) -> str:
    return re.sub(r"[\s_-]", "", text)


def _plain(name: str) -> str:
    """Lower case, single spaces for spaces and hyphens between letters, no last word "knot", "unknot" or "link"."""
    text = re.sub(r"(?<=[a-z])[\s_-]+(?=[a-z])", " ", name.strip().lower())
    return re.sub(r"\s+(knot|unknot|link|rings)$", "", re.sub(r"\s+", " ", text))
