"""Decide one stubborn pair of moving segments in exact integer arithmetic.

An interval of time is free of contact if (i) the edges are nowhere coplanar on it, or, in the plane, one edge stays
strictly on one side of the other's line, or (ii) a fixed plane separates them. Otherwise it is halved, until it is
free or so short that contact has to be assumed. (i) is a polynomial in t without sign changes among its Bernstein
coefficients; coordinates are floating-point numbers, hence integers after scaling, and everything stays exact.
"""

from collections.abc import Iterator, Sequence

import numpy as np

from ..types import FloatArray
from .planes import closest_chord

Vector = tuple[int, ...]
Frame = tuple[Vector, Vector, Vector]  # D = x₀ − y₀, e, f at one time, in a common integer unit

_MAX_DEPTH = 60  # shortest interval 2^-60
_MAX_INTERVALS = 600  # a bound for pathological motions that slide along each other
_SURE = 2.0**-10  # relative length below which a robust crossing needs no further localising


def first_contact(start: FloatArray, end: FloatArray) -> float | None:
    """Return a time before which two moving segments certainly don't meet, or None if they never do.

    ``start`` and ``end`` hold x₀, x₁, y₀, y₁, shape (4, m) with m = 2 or 3. The time is sharp to 2^-60, or to 0.1 %
    where the segments certainly cross, unless the segments stay that near for long.
    """
    first, last = _frames(start, end)
    work = [(0.0, 1.0, 0, first, last)]
    for _ in range(_MAX_INTERVALS):
        if not work:
            return None
        a, b, depth, first, last = work.pop()
        if _free(first, last):
            continue
        if depth == _MAX_DEPTH or (b - a < _SURE * a and _crosses(first, last)):
            return a
        middle = 0.5 * (a + b)
        half = _midpoint(first, last)
        work.append((middle, b, depth + 1, half, _doubled(last)))
        work.append((a, middle, depth + 1, _doubled(first), half))
    return work[-1][0] if work else None


def _frames(start: FloatArray, end: FloatArray) -> tuple[Frame, Frame]:
    ratios = [[x.as_integer_ratio() for x in row] for row in np.concatenate([start, end]).tolist()]
    unit = max(q for row in ratios for _, q in row)  # denominators are powers of two
    points = [tuple(p * (unit // q) for p, q in row) for row in ratios]
    return _frame(points[:4]), _frame(points[4:])


def _frame(points: Sequence[Vector]) -> Frame:
    x0, x1, y0, y1 = points
    return _minus(x0, y0), _minus(x1, x0), _minus(y1, y0)


def _free(first: Frame, last: Frame) -> bool:
    return _on_one_side(first, last) or _separated(first, last)


def _on_one_side(first: Frame, last: Frame) -> bool:
    """Prove by signs of Bernstein coefficients that the edges don't meet while they move from first to last."""
    if len(first[0]) == 2:
        return _beside(first, last)
    signs = {_sign(c) for c in _coplanarity(first, last)}
    if signs == {0}:  # a motion in a plane, or parallel edges: look at its three shadows
        axes = ((0, 1), (1, 2), (2, 0))
        return any(_beside(_shadow(first, pick), _shadow(last, pick)) for pick in axes)
    return len(signs) == 1


def _coplanarity(first: Frame, last: Frame) -> Iterator[int]:
    """Bernstein coefficients of det(D, e, f), cubic in time; the inner ones times 3."""
    (D, e, f), (G, g, h) = first, last
    yield _det(D, e, f)
    yield _det(G, e, f) + _det(D, g, f) + _det(D, e, h)
    yield _det(D, g, h) + _det(G, e, h) + _det(G, g, f)
    yield _det(G, g, h)


def _beside(first: Frame, last: Frame) -> bool:
    """In the plane: one edge lies strictly on one side of the other's line all the time."""
    (D, e, f), (G, g, h) = first, last
    zero = (0, 0)
    for a, b, p, q in ((f, h, e, g), (e, g, _minus(zero, f), _minus(zero, h))):
        ends = ((D, G), (_plus(D, p), _plus(G, q)))
        signs = {_sign(c) for u, v in ends for c in (_cross(a, u), _cross(a, v) + _cross(b, u), _cross(b, v))}
        if signs in ({1}, {-1}):
            return True
    return False


def _separated(first: Frame, last: Frame) -> bool:
    """Try the plane orthogonal to the closest direction half way."""
    frame = _midpoint(first, last)
    scale = max(abs(x) for vector in frame for x in vector) or 1
    motion = np.array([[x / scale for x in vector] for vector in frame])
    direction = closest_chord(motion[:, :, None])[:, 0]
    size = float(np.abs(direction).max())
    if not size > 0:
        return False
    n = tuple(int(x) for x in np.rint(np.ldexp(direction / size, 60)).tolist())
    return all(_gap(n, D, e, f) > 0 for D, e, f in (first, last))


def _gap(n: Vector, D: Vector, e: Vector, f: Vector) -> int:
    """The smallest of the four ⟨n, x_i − y_j⟩."""
    return _dot(n, D) + min(0, _dot(n, e)) - max(0, _dot(n, f))


def _crosses(first: Frame, last: Frame) -> bool:
    """Whether a crossing is plain: the plane changes side and the crossing point is well inside both edges."""
    if len(first[0]) == 2 or _det(*first) * _det(*last) >= 0:
        return False
    scale = max(abs(x) for vector in first for x in vector)
    D, e, f = (np.array([x / scale for x in vector]) for vector in first)
    solution = np.linalg.lstsq(np.stack([e, -f], axis=1), -D, rcond=None)[0]
    return bool(((solution > 0.01) & (solution < 0.99)).all())


def _midpoint(first: Frame, last: Frame) -> Frame:
    """Twice the frame half way; lengths count only up to a common factor."""
    D, e, f = (_plus(u, v) for u, v in zip(first, last, strict=True))
    return D, e, f


def _doubled(frame: Frame) -> Frame:
    D, e, f = (_plus(u, u) for u in frame)
    return D, e, f


def _shadow(frame: Frame, axes: tuple[int, int]) -> Frame:
    D, e, f = ((v[axes[0]], v[axes[1]]) for v in frame)
    return D, e, f


def _sign(x: int) -> int:
    return (x > 0) - (x < 0)


def _plus(u: Vector, v: Vector) -> Vector:
    return tuple(a + b for a, b in zip(u, v, strict=True))


def _minus(u: Vector, v: Vector) -> Vector:
    return tuple(a - b for a, b in zip(u, v, strict=True))


def _dot(u: Vector, v: Vector) -> int:
    return sum(a * b for a, b in zip(u, v, strict=True))


def _cross(u: Vector, v: Vector) -> int:
    return u[0] * v[1] - u[1] * v[0]


def _det(u: Vector, v: Vector, w: Vector) -> int:
    return u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) + u[2] * (v[0] * w[1] - v[1] * w[0])
