"""Decide one stubborn pair, of moving segments or of one and a triangle at rest, in exact integer arithmetic.

On an interval of time the segments x(s) = x₀ + s e and y(r) = y₀ + r f stay apart if their lines are nowhere coplanar,
det(D, e, f) ≠ 0, D = x₀ − y₀, or if a plane that moves along separates them: ⟨n(t), x_i(t) − y_j(t)⟩ > 0 for all four
i, j. The directions tried are those from the closest point on one of the edges' lines to an end of the other edge, and
from end to end: wherever such a pair of points is the closest one, its direction works, however small the gap. All of
these are polynomials in t, positive if their Bernstein coefficients are. An interval without such a proof is narrowed
down to the time when the lines are coplanar, if there is one such time, and halved otherwise.

If a segment and a triangle are apart at first, then at their first contact an end of the segment is in the triangle, or
the segment meets one of the triangle's edges: a segment that pierces it with both ends outside would have done so
shortly before.  So there are three pairs of segments and the paths of the two ends, which are segments too: whether one
of these crosses the triangle is decided by signs of determinants.  Of paths in its plane only the beginning matters,
because they enter the triangle through its edges; a triangle without area consists of its edges alone.

Coordinates are floating-point numbers, hence integers after scaling, and nothing that matters is ever rounded.
"""

import math
from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import pairwise

import numpy as np

from ..base import FloatArray

# Coefficients of a homogeneous polynomial in (1−t, t): Bernstein coefficients times positive binomials.
Polynomial = Sequence[int]
Vector = tuple[Polynomial, ...]
Motion = tuple[Vector, Vector, Vector]  # D, e, f, each linear

EDGES = ((2, 3), (3, 4), (4, 2))  # rows of a triangle's vertices, after those of the segment
_BITS = 40  # a single time of coplanarity is narrowed down by a factor of 2^-40 at a time


def first_contact(start: FloatArray, end: FloatArray, after: float = 0.0) -> float | None:
    """Return a time before which two moving segments certainly don't meet, or None if they never do.

    ``start`` and ``end`` hold x₀, x₁, y₀, y₁, shape (4, m) with m = 2 or 3; until ``after`` they are known not to
    meet. The time is nearly as sharp as a double. Segments that miss each other by less are taken to meet.
    """
    points = whole_numbers(np.concatenate([start, end]))
    x0, x1, y0, y1 = (tuple(zip(points[k], points[k + 4], strict=True)) for k in range(4))
    motion = _minus(x0, y0), _minus(x1, x0), _minus(y1, y0)
    if after <= 0 and not _free(_frame(motion, 0)):
        return 0.0
    work = [(Fraction(0), Fraction(1), motion)]
    for _ in range(600):  # a bound for pathological motions that touch all the time
        if not work:
            return None
        a, b, motion = work.pop()
        if b <= after or _free(motion):
            continue
        # as short as a double tells, or short enough for a plain crossing, which needs no sharper time
        if b - a <= max(Fraction(1, 2**60), b / 2**52) or (b - a <= b / 2**10 and _crosses(motion)):
            return max(below(a), after)
        if bracket := _only_root(motion):
            low, high = (a + (b - a) * Fraction(k, 2**_BITS) for k in bracket)
            work.append((low, high, _part(motion, *bracket)))
        else:
            middle = (a + b) / 2
            half = 2 ** (_BITS - 1)
            work.append((middle, b, _part(motion, half, 2 * half)))
            work.append((a, middle, _part(motion, 0, half)))
    return max(below(work[-1][0]), after) if work else None


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
    points = whole_numbers(np.concatenate([[p, q], triangle]))
    first, last, u, v, w = (tuple((x,) for x in row) for row in points)  # constant polynomials
    normal = _normal(_minus(v, u), _minus(w, u))
    (from_first,), (from_last,) = _dot(normal, _minus(first, u)), _dot(normal, _minus(last, u))
    if from_first * from_last > 0 or not any(c for (c,) in normal):
        return None
    height = from_first - from_last or 1
    # where the segment meets the plane, times the height
    point = [height * a + from_first * (b - a) for a, b in zip(*points[:2], strict=True)]
    for a, b in pairwise((u, v, w, u)):
        beside = tuple((x - height * y,) for x, (y,) in zip(point, a, strict=True))
        (side,) = _dot(normal, _normal(_minus(b, a), beside))
        if side * height < 0:
            return None
    return below(Fraction(from_first, height))


def whole_numbers(points: FloatArray) -> list[list[int]]:
    """Coordinates times a common denominator; shape (k, m)."""
    ratios = [[x.as_integer_ratio() for x in row] for row in points.tolist()]
    unit = max(q for row in ratios for _, q in row)  # denominators are powers of two
    return [[p * (unit // q) for p, q in row] for row in ratios]


def _frame(motion: Motion, time: int) -> Motion:
    """The motion stopped at its start, time 0, or at its end, time 1."""
    D, e, f = (tuple((p[time],) for p in vector) for vector in motion)
    return D, e, f


def _part(motion: Motion, first: int, last: int) -> Motion:
    """The motion from one time to another in units of 2^-40, all lengths times 2^40, or less by a common factor."""
    whole = 2**_BITS
    common = math.gcd(whole, first, last)
    whole, first, last = whole // common, first // common, last // common
    D, e, f = (
        tuple(((whole - first) * p + first * q, (whole - last) * p + last * q) for p, q in vector) for vector in motion
    )
    return D, e, f


def below(time: Fraction) -> float:
    """A double that is not greater, nor negative."""
    return float(time) if Fraction(float(time)) <= time else math.nextafter(float(time), 0.0)


def _free(motion: Motion) -> bool:
    """Whether the two lines are coplanar at no time, or a moving plane separates the segments all the time."""
    volume = _volume(motion) if len(motion[0]) == 3 else [0]
    return min(volume) > 0 or max(volume) < 0 or any(all(min(gap) > 0 for gap in gaps) for gaps in _gaps(motion))


def _only_root(motion: Motion) -> tuple[int, int] | None:
    """A short interval around the only time when the lines are coplanar, in units of 2^-40; None if there may be more.

    By Descartes' rule one change of sign among the coefficients means one root.
    """
    if len(motion[0]) == 2:
        return None
    volume = _volume(motion)
    signs = [c > 0 for c in volume if c]
    if not volume[0] or not volume[-1] or sum(p != q for p, q in pairwise(signs)) != 1:
        return None
    low, high, whole = 0, 2**_BITS, 2**_BITS
    while high - low > 1:
        middle = (low + high) // 2
        value = 0
        for k, c in enumerate(volume):
            value += c * (whole - middle) ** (len(volume) - 1 - k) * middle**k
        if value == 0:
            return middle - 1, middle + 1
        low, high = (middle, high) if (value > 0) == signs[0] else (low, middle)
    return low, high


def _gaps(motion: Motion) -> Iterator[Iterator[Polynomial]]:
    """For each direction n that is tried, the different ones among the four ⟨n, x_i − y_j⟩."""
    D, e, f = motion
    E, F = _plus(D, e), _minus(D, f)  # x₁ − y₀ and x₀ − y₁
    G = _minus(E, f)
    for line, ends in ((f, (D, E)), (e, (D, F))):  # orthogonal to an edge, both of whose ends are at the same height
        square = _dot(line, line)
        for corner in ends:  # ⟨corner |line|² − line ⟨line, corner⟩, other⟩
            along = _dot(line, corner)
            yield (_difference(_times(square, _dot(corner, o)), _times(along, _dot(line, o))) for o in ends)
    for corner in (D, E, F, G):
        yield (_dot(corner, other) for other in (D, E, F, G))


def _crosses(motion: Motion) -> bool:
    """Whether the segments plainly meet during a short motion."""
    if len(motion[0]) == 2:
        # whether two segments in the plane, standing still, cross properly
        D, e, f = _frame(motion, 1)
        sides = [_cross(f, D), _cross(f, _plus(D, e)), _cross(e, D), _cross(e, _minus(D, f))]
        (p,), (q,), (r,), (s,) = sides
        return p * q < 0 and r * s < 0
    volume = _volume(motion)
    if volume[0] * volume[-1] >= 0:
        return False
    for time in (0, 1):  # where the lines, standing still, come nearest must be plainly inside both edges
        D, e, f = _frame(motion, time)
        normal = _normal(e, f)
        (whole,) = _dot(normal, normal)
        for line in (f, e):
            (part,) = _dot(_normal(line, D), normal)  # s |e × f|² and r |e × f|²
            if min(part, whole - part) * 10**6 <= whole:
                return False
    return True


def _volume(motion: Motion) -> Polynomial:
    D, e, f = motion
    return _dot(D, _normal(e, f))


def _normal(u: Vector, v: Vector) -> Vector:
    return tuple(_cross((u[i], u[j]), (v[i], v[j])) for i, j in ((1, 2), (2, 0), (0, 1)))


def _cross(u: Vector, v: Vector) -> Polynomial:
    return _difference(_times(u[0], v[1]), _times(u[1], v[0]))


def _dot(u: Vector, v: Vector) -> Polynomial:
    return [sum(terms) for terms in zip(*map(_times, u, v), strict=True)]


def _plus(u: Vector, v: Vector) -> Vector:
    return tuple([a + b for a, b in zip(p, q, strict=True)] for p, q in zip(u, v, strict=True))


def _minus(u: Vector, v: Vector) -> Vector:
    return tuple(_difference(p, q) for p, q in zip(u, v, strict=True))


def _difference(p: Polynomial, q: Polynomial) -> Polynomial:
    return [a - b for a, b in zip(p, q, strict=True)]


def _times(p: Polynomial, q: Polynomial) -> Polynomial:
    product = [0] * (len(p) + len(q) - 1)
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            product[i + j] += a * b
    return product
