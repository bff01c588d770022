"""Braid words, diagrams of their closures, and closures as polygons on the cubic lattice.

A word is a tuple of signed letters; letter i is the crossing σ_i of strands i and i+1, −i its inverse.  A positive
letter is a positive (right-handed) crossing, so the closure of (1, 1, 1) is the right-handed trefoil.
"""

from collections.abc import Sequence

import numpy as np

from ..curve import Curve
from ..diagrams import Diagram, Pass, diagram_of
from ..errors import CurveError
from ..types import IntArray

Word = tuple[int, ...]

MAX_STRANDS = 500  # of braids of any use
MAX_LETTERS = 20_000
_COLUMN = 3  # length of a crossing along the strands
_Corner = tuple[int, int, int]


def checked_word(word: Sequence[int], strands: int | None = None) -> tuple[Word, int]:
    """A word and its number of strands, the least by default; CurveError if letters are 0 or strands do not fit."""
    letters = tuple(word)
    for position, letter in enumerate(letters, start=1):
        if int(letter) != letter or letter == 0:
            raise CurveError(f"letter {position} of the braid word is {letter!r}; letters are whole numbers, not 0")
    letters = tuple(map(int, letters))
    needed = max(map(abs, letters), default=0) + 1
    strands = needed if strands is None else strands
    if strands < needed:
        raise CurveError(f"the braid has {strands} strands, but its letters need {needed}")
    if strands > MAX_STRANDS or len(letters) > MAX_LETTERS:
        raise CurveError(
            f"the braid has {strands} strands and {len(letters)} letters; "
            f"at most {MAX_STRANDS} and {MAX_LETTERS} are allowed"
        )
    return letters, strands


def cycles(word: Sequence[int], strands: int) -> list[list[int]]:
    """For each component of the closure the places, from 0, where its turns begin; each starts with its smallest."""
    at = list(range(strands))
    for letter in word:
        i = abs(letter) - 1
        at[i], at[i + 1] = at[i + 1], at[i]
    ends = {strand: place for place, strand in enumerate(at)}
    found: list[list[int]] = []
    for place in range(strands):
        cycle = []
        while place in ends:
            cycle.append(place)
            place = ends.pop(place)
        found += [cycle] if cycle else []
    return found


def columns(word: Sequence[int]) -> tuple[list[int], int]:
    """The first column where each letter's strands are free, as letters that share none commute; how many columns."""
    free: dict[int, int] = {}
    places = []
    for letter in word:
        i = abs(letter)
        place = max(free.get(i, 0), free.get(i + 1, 0))
        free[i] = free[i + 1] = place + 1
        places.append(place)
    return places, max(free.values(), default=0)


def mirror(word: Sequence[int]) -> Word:
    return tuple(-letter for letter in word)


def connected_sum(first: Sequence[int], second: Sequence[int]) -> Word:
    """Word whose closure is the connected sum, the second braid attached to the first one's last strand."""
    shift = max(map(abs, first), default=0)
    return (*first, *(letter + shift if letter > 0 else letter - shift for letter in second))


def braid_diagram(word: Sequence[int]) -> Diagram:
    """The closure of a braid as the word draws it; raises as `checked_word` does."""
    letters, strands = checked_word(word)
    passes: list[list[Pass]] = [[] for _ in range(strands)]
    at = list(range(strands))
    for crossing, letter in enumerate(letters):
        place = abs(letter) - 1
        passes[at[place]].append((crossing, letter > 0))  # in a positive crossing the one that moves outwards is over
        passes[at[place + 1]].append((crossing, letter < 0))
        at[place], at[place + 1] = at[place + 1], at[place]
    parts = (tuple(each for strand in cycle for each in passes[strand]) for cycle in cycles(letters, strands))
    return Diagram(tuple(parts), tuple(1 if letter > 0 else -1 for letter in letters))


def plat_diagram(word: Sequence[int]) -> Diagram:
    """The plat of a braid: its strands, an even number, are joined in pairs at either end; raises as `checked_word`.

    With three strands' letters these are the two-bridge links (Birman 1976).
    """
    letters, strands = checked_word(word)
    ends = [place // 2 for place in range(strands + strands % 2)]  # the edge that comes up at each place
    new, circles = len(ends) // 2, 0
    code: list[tuple[int, ...]] = []
    for letter in letters:
        i = abs(letter) - 1
        left, right = ends[i : i + 2]
        code.append((right, new + 1, new, left) if letter > 0 else (left, right, new + 1, new))
        ends[i : i + 2] = new, new + 1
        new += 2
    for place in range(0, len(ends), 2):
        kept, other = ends[place : place + 2]
        circles += kept == other
        code = [tuple(kept if edge == other else edge for edge in edges) for edges in code]
        ends = [kept if edge == other else edge for edge in ends]
    diagram = diagram_of(code)
    return Diagram((*diagram.passes, *((),) * circles), diagram.signs)


def lattice_closure(word: Sequence[int], *, strands: int | None = None) -> Curve:
    """Make the closure of a braid as a polygon with corners on the integer lattice and edges along its axes.

    Strands run along y at x = 0, 1, …, one step below those that cross over them, and return in the plane z = 0.

    Parameters
    ----------
    word
        Letters ±i, see :mod:`mobius_flow.core.knots.braids`.
    strands
        Number of strands, by default as few as the word needs.

    Raises
    ------
    CurveError
        If it is no braid word.

    Examples
    --------
    >>> len(lattice_closure([1, 1, 1]))
    29
    """
    letters, count = checked_word(word, strands)
    places, width = columns(letters)
    crossings = {}
    for letter, column in zip(letters, places, strict=True):
        left, over = abs(letter) - 1, letter > 0
        crossings[column, left] = 1, over
        crossings[column, left + 1] = -1, not over
    components = []
    for cycle in cycles(letters, count):
        path: list[_Corner] = []
        for place in cycle:
            path += _strand(crossings, width, place, count)
        components.append(_corners(np.array(path)))
    return Curve.from_components(components)


def _strand(crossings: dict[tuple[int, int], tuple[int, bool]], width: int, place: int, count: int) -> list[_Corner]:
    """The strand that starts at a place, and its way back to where the next one starts."""
    path = [(place, 0, 0)]
    for column in range(width):
        step, over = crossings.get((column, place), (0, False))
        y, beyond = _COLUMN * column, place + step
        if over:
            path += [(place, y, 0), (place, y, 1), (place, y + 2, 1), (beyond, y + 2, 1), (beyond, y + 2, 0)]
        elif step:
            path += [(place, y + 1, 0), (beyond, y + 1, 0)]
        place = beyond
    outward = count - place
    top, side, bottom = _COLUMN * width + outward, count - 1 + outward, -outward
    return [*path, (place, top, 0), (side, top, 0), (side, bottom, 0), (place, bottom, 0)]


def _corners(path: IntArray) -> IntArray:
    """The vertices of a closed lattice path at which it turns."""
    path = path[np.any(path != np.roll(path, -1, axis=0), axis=1)]
    before, after = path - np.roll(path, 1, axis=0), np.roll(path, -1, axis=0) - path
    return np.asarray(path[np.any(np.sign(before) != np.sign(after), axis=1)])
