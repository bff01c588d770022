"""Decide one stubborn pair of a moving segment and a triangle at rest, in exact arithmetic.

If the two are apart at first, then at their first contact an end of the segment is in the triangle, or the segment
meets one of the triangle's edges: a segment that pierces it with both ends outside would have done so shortly before.
So there are three pairs of segments, as for the curve itself, and the paths of the two ends, which are segments too:
whether one of these crosses the triangle is decided by signs of determinants. Of paths in its plane only the beginning
matters, because they enter the triangle through its edges; a triangle without area consists of its edges alone.
"""

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise

import numpy as np

from ..base.types import FloatArray
from .exact import below, first_contact, whole_numbers

Vector = Sequence[int]

EDGES = ((2, 3), (3, 4), (4, 2))  # rows of the triangle's vertices


def first_contact_with_triangle(start: FloatArray, end: FloatArray, after: float = 0.0) -> float | None:
    """Return a time before which a moving segment certainly does not meet a triangle, or None if it never does.

    ``start`` and ``end`` hold x₀, x₁, y₀, y₁, y₂, shape (5, 3), of which the last three do not move; until ``after``
    the two are known not to meet. As sharp as `first_contact` is.
    """
    if after <= 0 and crossing(start[0], start[1], start[2:]) is not None:
        return 0.0
    times = [first_contact(start[[0, 1, a, b]], end[[0, 1, a, b]], after) for a, b in EDGES]
    times += [crossing(start[k], end[k], start[2:]) for k in (0, 1)]
    return min((time for time in times if time is not None), default=None)


def crossing(p: FloatArray, q: FloatArray, triangle: FloatArray) -> float | None:
    """Return the parameter of the point at which the segment from p to q meets a triangle, shape (3, 3), rounded down.

    None if there is no such point. For a segment in the triangle's plane only its first end is examined: if that is
    not in the triangle, the segment may still meet its edges.
    """
    first, last, *corners = whole_numbers(np.concatenate([[p, q], triangle]))
    u, v, w = corners
    normal = _cross(_minus(v, u), _minus(w, u))
    from_first, from_last = _dot(normal, _minus(first, u)), _dot(normal, _minus(last, u))
    if from_first * from_last > 0 or not any(normal):
        return None
    height = from_first - from_last or 1
    # the point where the segment meets the plane, and the corners, times the height
    point = [height * a + from_first * (b - a) for a, b in zip(first, last, strict=True)]
    for a, b in pairwise([*corners, u]):
        side = _dot(normal, _cross(_minus(b, a), _minus(point, [height * x for x in a])))
        if side * height < 0:
            return None
    return below(Fraction(from_first, height))


def _minus(u: Vector, v: Vector) -> Vector:
    return [a - b for a, b in zip(u, v, strict=True)]


def _dot(u: Vector, v: Vector) -> int:
    return sum(a * b for a, b in zip(u, v, strict=True))


def _cross(u: Vector, v: Vector) -> Vector:
    return [u[i] * v[j] - u[j] * v[i] for i, j in ((1, 2), (2, 0), (0, 1))]
