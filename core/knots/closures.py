"""Closures of braids: strands on concentric circles, every crossing a smooth half twist of two neighbours."""

import math
from collections.abc import Sequence
from functools import partial

import numpy as np

from ..arguments import checked
from ..curve import Curve
from ..types import FloatArray, IntArray
from .braids import Word, checked_word, columns, cycles, permutation
from .rings import ClosedBraid, Ring

_COLUMN = 2.2  # length of a crossing along the innermost strand, in units of the strands' distance


@checked
def braid_closure(word: Sequence[int], vertices: int | None = None, *, strands: int | None = None) -> Curve:
    """Make the closure of a braid, one component per cycle of its permutation.

    The strands are concentric circles around the z axis, unit distance apart before the whole is scaled to a
    middle radius of 1; seen from above the curve is the usual picture of the closed braid.

    Parameters
    ----------
    word
        Letters ±i, see :mod:`mobius_flow.core.knots.braids`; empty for the trivial braid.
    vertices
        Total number of vertices; by default so many that edges are shorter than strands are apart.
    strands
        Number of strands, by default as few as the word needs.

    Raises
    ------
    CurveError
        If the word is none or the vertices are too few.

    Examples
    --------
    >>> braid_closure([1, -2, 1, -2], vertices=100).mesh.component_sizes
    (100,)
    >>> len(braid_closure([1, 1]).mesh.component_sizes)
    2
    """
    letters, count = checked_word(word, strands)
    return _smooth(letters, count).polygon(vertices)


def _smooth(word: Word, strands: int) -> ClosedBraid:
    """The closed braid as smooth curves, middle radius 1."""
    places, width = columns(word)
    inner = max(_COLUMN * width / (2 * math.pi), 1.0)
    scale = 1.0 / (inner + (strands - 1) / 2)
    letters = _letter_table(word, places, strands, max(width, 1))
    rings = [
        Ring(len(cycle), partial(_profile, letters, np.array(cycle), inner, scale))
        for cycle in cycles(permutation(word, strands))
    ]
    return ClosedBraid(rings, gap=scale, detail=max(60, 2 * strands * width))


def _letter_table(word: Word, places: list[int], strands: int, width: int) -> tuple[IntArray, IntArray]:
    """For each column and each place before it: where the strand goes (−1, 0, 1), and the crossing's sign.

    Returns two arrays (width, strands).
    """
    step = np.zeros((width, strands), dtype=np.intp)
    sign = np.zeros((width, strands), dtype=np.intp)
    for letter, column in zip(word, places, strict=True):
        i = abs(letter) - 1
        step[column, i], step[column, i + 1] = 1, -1
        sign[column, i : i + 2] = 1 if letter > 0 else -1
    return step, sign


def _profile(
    letters: tuple[IntArray, IntArray], cycle: IntArray, inner: float, scale: float, theta: FloatArray
) -> FloatArray:
    """Distance from the axis and height of one component at angles (k,); shape (k, 2)."""
    step, sign = letters
    width = len(step)
    along = np.asarray(theta, dtype=np.float64) / (2 * math.pi) * width
    # The clip keeps the closing angle 2π·turns in the last column instead of past it.
    column = np.clip(np.floor(along).astype(np.intp), 0, width * len(cycle) - 1)
    places = _places(step, cycle)[column]
    angle = math.pi * _smoothstep(along - column)
    moves, signs = step[column % width, places], sign[column % width, places]
    radius = inner + places + 0.5 * moves * (1 - np.cos(angle))
    # The strand moving outwards passes over in a positive crossing and under in a negative one.
    height = 0.5 * moves * signs * np.sin(angle)
    return np.stack([scale * radius, scale * height], axis=1)


def _places(step: IntArray, cycle: IntArray) -> IntArray:
    """The place before every column, turn after turn; shape (width · turns,)."""
    places = []
    for start in cycle:
        place = int(start)
        for moves in step:
            places.append(place)
            place += int(moves[place])
    return np.array(places, dtype=np.intp)


def _smoothstep(x: FloatArray) -> FloatArray:
    return np.asarray(x * x * (3.0 - 2.0 * x))
