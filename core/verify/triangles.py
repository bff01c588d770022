"""Whether a moving segment meets a triangle that stands still: decided exactly, for any rational points.

If they are apart at first, then at their first contact the segment meets an edge of the triangle, or one of its ends is
in the triangle: were it to pierce the triangle with both ends outside, it would have done so shortly before. The way of
an end is a segment too, and so it remains to see whether three segments (the one that moves, at first, and the ways of
its ends) meet the triangle. If one of them is in its plane, it meets an edge, or begins in the triangle, or not at all.
A triangle without area is nothing but its edges.
"""

from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations

from .segments import Point, meet


def meet_triangle(start: Sequence[Point], end: Sequence[Point]) -> bool:
    """Whether a segment that moves and a triangle that does not meet at any time in [0, 1].

    Parameters
    ----------
    start, end
        The points x₀, x₁, y₀, y₁, y₂ at times 0 and 1; the last three are the same at both.
    """
    x, triangle = list(start[:2]), list(start[2:])
    if any(pierced_at(p, q, triangle) is not None for p, q in [x, (start[0], end[0]), (start[1], end[1])]):
        return True
    return any(meet([*x, *edge], [*end[:2], *edge]) for edge in combinations(triangle, 2))


def pierced_at(p: Point, q: Point, triangle: Sequence[Point]) -> Fraction | None:
    """The parameter at which the segment from p to q meets a triangle; None if it does not.

    By Cramer's rule for p + s (q − p) = y₀ + r f + t g. If they are in one plane it is 0, or None if p is not in the
    triangle: that the segment meets its edges must be seen elsewhere.
    """
    y0, y1, y2 = triangle
    f, g, d, D = _minus(y1, y0), _minus(y2, y0), _minus(p, q), _minus(p, y0)
    volume = _det(d, f, g)
    if volume == 0:
        return Fraction(0) if _in_plane_and_inside(D, f, g) else None
    s, r, t = (_det(*columns) / volume for columns in ((D, f, g), (d, D, g), (d, f, D)))
    inside = 0 <= s <= 1 and r >= 0 and t >= 0 and r + t <= 1
    return s if inside else None


def _in_plane_and_inside(D: Point, f: Point, g: Point) -> bool:
    """Whether D = r f + t g with r, t ≥ 0 and r + t ≤ 1, for a triangle with an area; by the normal equations."""
    ff, fg, gg, Df, Dg = _dot(f, f), _dot(f, g), _dot(g, g), _dot(D, f), _dot(D, g)
    whole = ff * gg - fg * fg
    if whole == 0 or _det(D, f, g) != 0:
        return False
    r, t = (Df * gg - Dg * fg) / whole, (Dg * ff - Df * fg) / whole
    return r >= 0 and t >= 0 and r + t <= 1


def _minus(u: Point, v: Point) -> Point:
    return [a - b for a, b in zip(u, v, strict=True)]


def _dot(u: Point, v: Point) -> Fraction:
    return sum((a * b for a, b in zip(u, v, strict=True)), Fraction(0))


def _det(u: Point, v: Point, w: Point) -> Fraction:
    products = (u[i] * (v[j] * w[k] - v[k] * w[j]) for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)))
    return sum(products, Fraction(0))
