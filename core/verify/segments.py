"""Whether a moving segment meets another one, or a triangle at rest: decided exactly, for rational points.

Two segments
------------
Segments x(s) = x₀ + s e and y(r) = y₀ + r f, s, r in [0, 1], with end points linear in time t in [0, 1]; D = x₀ − y₀;
either may have no length. They are tested for a common point, by signs of polynomials at algebraic numbers, at finitely
many times, among which is the first contact t* if there is one:

1. det(D, e, f) is not the zero polynomial. A common point makes D, e, f dependent, so t* is one of its roots.
2. It is zero: the segments are coplanar all the time (in the plane always). If t* > 0, an end of one lies on the other
   at t*: segments that are not parallel and cross inside both would have crossed shortly before; parallel ones
   overlap in a segment or a point whose ends are ends of theirs. Let the end be p and the other segment y.
   a. |f × (p − y₀)|² is not zero: t* is one of its roots.
   b. It is zero: p is on y's line all the time. Were p inside y at t*, y having a length, p would have been inside
      shortly before. So p is at an end of y at t*, a root of |p − y_j|² (which is not zero, as then t* = 0).
   So t* is 0 or a root of one of the polynomials of a and b that are not zero.

A common point is found as follows: if e × f ≠ 0, Cramer's rule gives at most one pair (s, r), a common point if
⟨D, e × f⟩ = 0 and s and r are in [0, 1]. If e × f = 0, an end of one must lie on the other, as in 2.

A segment and a triangle
------------------------
If they are apart at first, then at their first contact the segment meets an edge of the triangle, or one of its ends is
in the triangle: if it pierced the triangle with both ends outside, it would have done so shortly before. The path of
an end is a segment too, so it remains to see whether three segments (the moving one, at first, and the paths of
its ends) meet the triangle. If one of them is in its plane, it meets an edge, or begins in the triangle, or not at all.
A triangle without area is nothing but its edges.
"""

import math
from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import combinations

from .polynomials import ZERO, Polynomial, Root, add, multiply, roots, subtract

Point = Sequence[Fraction]
Vector = tuple[Polynomial, Polynomial, Polynomial]
Corners = tuple[Vector, Vector, Vector, Vector]  # x₀ − y₀, x₀ − y₁, x₁ − y₀, x₁ − y₁


def meet(start: Sequence[Point], end: Sequence[Point]) -> bool:
    """Whether two moving segments meet at any time in [0, 1]; parameters as in `meetings`."""
    return any(True for _ in meetings(start, end))


def meetings(start: Sequence[Point], end: Sequence[Point]) -> Iterator[Root]:
    """Yield times when segments x₀x₁ and y₀y₁ meet, the first among them; points in R² or R³ at times 0 and 1."""
    x0, x1, y0, y1 = _moving_points(start, end)
    corners = (_minus(x0, y0), _minus(x0, y1), _minus(x1, y0), _minus(x1, y1))
    e, f = _minus(x1, x0), _minus(y1, y0)
    return (time for time in _candidates(corners, e, f) if _touch(time, corners, e, f))


def _moving_points(start: Sequence[Point], end: Sequence[Point]) -> list[Vector]:
    """The four points as polynomials in t, scaled to integers; the plane lies in space."""
    unit = math.lcm(*(x.denominator for point in (*start, *end) for x in point))
    flat = [0] * (3 - len(start[0]))
    moving = []
    for p, q in zip(start, end, strict=True):
        first, last = ([int(x * unit) for x in point] + flat for point in (p, q))
        a, b, c = (add((u,) if u else (), (0, v - u) if v != u else ()) for u, v in zip(first, last, strict=True))
        moving.append((a, b, c))
    return moving


def _candidates(corners: Corners, e: Vector, f: Vector) -> Iterator[Root]:
    """Times among which the first contact is, if there is one."""
    volume = _dot(corners[0], _cross(e, f))
    if volume:
        yield from roots(volume)
        return
    yield ZERO
    for offset, line in _ends(corners, e, f):
        height = _cross(line, offset)
        yield from _roots_unless_zero(_dot(height, height))
    for corner in corners:
        yield from _roots_unless_zero(_dot(corner, corner))


def _ends(corners: Corners, e: Vector, f: Vector) -> tuple[tuple[Vector, Vector], ...]:
    """Each of the four ends relative to the first point of the other segment, and that segment's vector."""
    x0y0, x0y1, x1y0, _ = corners
    return (x0y0, f), (x1y0, f), (_minus(_ORIGIN, x0y0), e), (_minus(_ORIGIN, x0y1), e)


def _touch(time: Root, corners: Corners, e: Vector, f: Vector) -> bool:
    if time.sign_of(_dot(_cross(e, f), _cross(e, f))):
        return _lines_meet_inside(time, corners[0], e, f)
    # Parallel, or of no length: they meet if an end of one lies on the other.
    return any(_lies_on(time, offset, line) for offset, line in _ends(corners, e, f))


def _lines_meet_inside(time: Root, D: Vector, e: Vector, f: Vector) -> bool:
    """Whether segments that are not parallel meet: D + s e − r f = 0 with s and r in [0, 1]."""
    normal = _cross(e, f)
    if time.sign_of(_dot(D, normal)):
        return False
    whole = _dot(normal, normal)
    # s and r are these numerators divided by |e × f|².
    numerators = (_dot(_cross(f, D), normal), _dot(_cross(e, D), normal))
    return all(time.sign_of(p) >= 0 and time.sign_of(subtract(whole, p)) >= 0 for p in numerators)


def _lies_on(time: Root, offset: Vector, line: Vector) -> bool:
    """Whether the point at ``offset`` from the first end of a segment lies on it."""
    height, along, whole = _cross(line, offset), _dot(line, offset), _dot(line, line)
    if time.sign_of(whole) == 0:
        return time.sign_of(_dot(offset, offset)) == 0
    return (
        time.sign_of(_dot(height, height)) == 0
        and time.sign_of(along) >= 0
        and time.sign_of(subtract(whole, along)) >= 0
    )


def _roots_unless_zero(p: Polynomial) -> list[Root]:
    return roots(p) if p else []


_ORIGIN: Vector = ((), (), ())


def _minus(u: Vector, v: Vector) -> Vector:
    a, b, c = (subtract(p, q) for p, q in zip(u, v, strict=True))
    return a, b, c


def _dot(u: Vector, v: Vector) -> Polynomial:
    total: Polynomial = ()
    for p, q in zip(u, v, strict=True):
        total = add(total, multiply(p, q))
    return total


def _cross(u: Vector, v: Vector) -> Vector:
    a, b, c = (subtract(multiply(u[i], v[j]), multiply(u[j], v[i])) for i, j in ((1, 2), (2, 0), (0, 1)))
    return a, b, c


def meet_triangle(start: Sequence[Point], end: Sequence[Point]) -> bool:
    """Whether a moving segment meets a triangle at rest in [0, 1]; points x₀, x₁, y₀, y₁, y₂ at times 0 and 1."""
    x, triangle = list(start[:2]), list(start[2:])
    if any(pierced_at(p, q, triangle) is not None for p, q in [x, (start[0], end[0]), (start[1], end[1])]):
        return True
    return any(meet([*x, *edge], [*end[:2], *edge]) for edge in combinations(triangle, 2))


def pierced_at(p: Point, q: Point, triangle: Sequence[Point]) -> Fraction | None:
    """The parameter at which the segment from p to q meets a triangle; None if it does not.

    By Cramer's rule for p + s (q − p) = y₀ + r f + t g. If they are in one plane it is 0, or None if p is not in the
    triangle: whether the segment meets its edges must be decided elsewhere.
    """
    y0, y1, y2 = triangle
    f, g, d, D = _difference(y1, y0), _difference(y2, y0), _difference(p, q), _difference(p, y0)
    volume = _det(d, f, g)
    if volume == 0:
        return Fraction(0) if _in_plane_and_inside(D, f, g) else None
    s, r, t = (_det(*columns) / volume for columns in ((D, f, g), (d, D, g), (d, f, D)))
    inside = 0 <= s <= 1 and r >= 0 and t >= 0 and r + t <= 1
    return s if inside else None


def _in_plane_and_inside(D: Point, f: Point, g: Point) -> bool:
    """Whether D = r f + t g with r, t ≥ 0 and r + t ≤ 1, for a triangle with an area; by the normal equations."""
    ff, fg, gg, Df, Dg = _inner(f, f), _inner(f, g), _inner(g, g), _inner(D, f), _inner(D, g)
    whole = ff * gg - fg * fg
    if whole == 0 or _det(D, f, g) != 0:
        return False
    r, t = (Df * gg - Dg * fg) / whole, (Dg * ff - Df * fg) / whole
    return r >= 0 and t >= 0 and r + t <= 1


def _difference(u: Point, v: Point) -> Point:
    return [a - b for a, b in zip(u, v, strict=True)]


def _inner(u: Point, v: Point) -> Fraction:
    return sum((a * b for a, b in zip(u, v, strict=True)), Fraction(0))


def _det(u: Point, v: Point, w: Point) -> Fraction:
    products = (u[i] * (v[j] * w[k] - v[k] * w[j]) for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)))
    return sum(products, Fraction(0))
