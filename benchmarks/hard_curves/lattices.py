"""Closures of braids as polygons on the cubic lattice: coarse, with parallel edges that hide each other."""

import numpy as np
from mobius_flow.core import Curve
from mobius_flow.core.base.types import IntArray
from mobius_flow.core.knots.braids import Word, checked_word, columns, cycles

_COLUMN = 3  # length of a crossing along the strands
_Corner = tuple[int, int, int]


def lattice_closure(word: Word) -> Curve:
    """The closure of a braid as a polygon with corners on the integer lattice and edges along its axes.

    Strands run along y at x = 0, 1, …, one step below those that cross over them, and return in the plane z = 0.
    """
    letters, count = checked_word(word)
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
