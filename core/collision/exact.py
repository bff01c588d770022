"""Decide one stubborn pair of moving segments in exact integer arithmetic.

On an interval of time the segments x(s) = x₀ + s e and y(r) = y₀ + r f stay apart if their lines are nowhere coplanar,
det(D, e, f) ≠ 0, D = x₀ − y₀, or if a plane that moves along separates them: ⟨n(t), x_i(t) − y_j(t)⟩ > 0 for all four
i, j. The directions tried are those from the closest point on one of the edges' lines to an end of the other edge, and
from end to end: wherever such a pair of points is the closest one, its direction works, however small the gap. All of
these are polynomials in t, positive if their Bernstein coefficients are. An interval without such a proof is halved.

Coordinates are floating-point numbers, hence integers after scaling, and nothing is ever rounded.
"""

from collections.abc import Iterator, Sequence

import numpy as np

from ..types import FloatArray

# Coefficients of a homogeneous polynomial in (1−t, t): Bernstein coefficients times positive binomials.
Polynomial = Sequence[int]
Vector = tuple[Polynomial, ...]
Motion = tuple[Vector, Vector, Vector]  # D, e, f, each linear

_MAX_DEPTH = 60  # shortest interval 2^-60
_FINEST = 2.0**-52  # relative length of an interval that is given up
_SURE = 2.0**-10  # relative length below which a robust crossing needs no further localising
_NORMALS_EVERY = 3  # levels of halving from one attempt with moving planes to the next: they are dear
_MAX_INTERVALS = 600  # a bound for pathological motions that touch all the time


def first_contact(start: FloatArray, end: FloatArray, after: float = 0.0) -> float | None:
    """Return a time before which two moving segments certainly don't meet, or None if they never do.

    ``start`` and ``end`` hold x₀, x₁, y₀, y₁, shape (4, m) with m = 2 or 3; until ``after`` they are known not to
    meet. The time is sharp to 0.1 % where the
    segments plainly cross; elsewhere it is as sharp as a double.
    """
    motion = _motion(start, end)
    if after <= 0 and not (_skew(_at_start(motion)) or _separated(_at_start(motion))):
        return 0.0
    work = [(0.0, 1.0, 0, motion)]
    for _ in range(_MAX_INTERVALS):
        if not work:
            return None
        a, b, depth, motion = work.pop()
        if b <= after or _skew(motion) or (depth % _NORMALS_EVERY == 0 and _separated(motion)):
            continue
        if depth == _MAX_DEPTH or b - a < _FINEST * b or (b - a < _SURE * a and _crosses(motion)):
            return max(a, after)
        middle = 0.5 * (a + b)
        first, second = _halves(motion)
        work += [(middle, b, depth + 1, second), (a, middle, depth + 1, first)]
    return max(work[-1][0], after) if work else None


def _motion(start: FloatArray, end: FloatArray) -> Motion:
    ratios = [[x.as_integer_ratio() for x in row] for row in np.concatenate([start, end]).tolist()]
    unit = max(q for row in ratios for _, q in row)  # denominators are powers of two
    points = [[p * (unit // q) for p, q in row] for row in ratios]
    x0, x1, y0, y1 = (tuple(zip(points[k], points[k + 4], strict=True)) for k in range(4))
    return _minus(x0, y0), _minus(x1, x0), _minus(y1, y0)


def _at_start(motion: Motion) -> Motion:
    D, e, f = (tuple((p[0],) for p in vector) for vector in motion)
    return D, e, f


def _halves(motion: Motion) -> tuple[Motion, Motion]:
    """The two halves of a motion, all lengths doubled."""
    D, e, f = (tuple((2 * p, p + q) for p, q in vector) for vector in motion)
    G, g, h = (tuple((p + q, 2 * q) for p, q in vector) for vector in motion)
    return (D, e, f), (G, g, h)


def _skew(motion: Motion) -> bool:
    """Whether the two lines are coplanar at no time."""
    if len(motion[0]) == 2:
        return False
    volume = _volume(motion)
    return min(volume) > 0 or max(volume) < 0


def _separated(motion: Motion) -> bool:
    """Whether one of the moving planes separates the segments all the time."""
    return any(all(min(gap) > 0 for gap in gaps) for gaps in _gaps(motion))


def _gaps(motion: Motion) -> Iterator[Iterator[Polynomial]]:
    """For each direction n that is tried, the different ones among the four ⟨n, x_i − y_j⟩."""
    D, e, f = motion
    E, F = _plus(D, e), _minus(D, f)  # x₁ − y₀ and x₀ − y₁
    G = _minus(E, f)
    ff, ee = _dot(f, f), _dot(e, e)
    for corner in (D, E):  # orthogonal to f: both ends of y are at the same height
        fc = _dot(f, corner)
        # ⟨corner·ff − f·fc, other⟩
        yield (_difference(_times(ff, _dot(corner, other)), _times(fc, _dot(f, other))) for other in (D, E))
    for corner in (D, F):
        ec = _dot(e, corner)
        yield (_difference(_times(ee, _dot(corner, other)), _times(ec, _dot(e, other))) for other in (D, F))
    for corner in (D, E, F, G):
        yield (_dot(corner, other) for other in (D, E, F, G))


def _crosses(motion: Motion) -> bool:
    """Whether the segments plainly meet during a short motion."""
    if len(motion[0]) == 2:
        return _crosses_in_plane(motion)
    volume = _volume(motion)
    return volume[0] * volume[-1] < 0 and _well_inside(motion, 0) and _well_inside(motion, -1)


def _well_inside(motion: Motion, time: int) -> bool:
    """Whether the point where the lines come nearest is well inside both edges, at the first or last time."""
    vectors = [[p[time] for p in vector] for vector in motion]
    scale = max(abs(x) for vector in vectors for x in vector)
    D, e, f = (np.array([x / scale for x in vector]) for vector in vectors)
    solution = np.linalg.lstsq(np.stack([e, -f], axis=1), -D, rcond=None)[0]
    return bool(((solution > 0.01) & (solution < 0.99)).all())


def _crosses_in_plane(motion: Motion) -> bool:
    """Whether the segments cross properly at the end."""
    D, e, f = (tuple((p[-1],) for p in vector) for vector in motion)
    sides = [_cross(f, D), _cross(f, _plus(D, e)), _cross(e, D), _cross(e, _minus(D, f))]
    (p,), (q,), (r,), (s,) = sides
    return p * q < 0 and r * s < 0


def _volume(motion: Motion) -> Polynomial:
    """det(D, e, f)."""
    D, e, f = motion
    normal = tuple(_cross((e[i], e[j]), (f[i], f[j])) for i, j in ((1, 2), (2, 0), (0, 1)))
    return _dot(D, normal)


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
