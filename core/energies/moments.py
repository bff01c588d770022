"""Moments of 1/r² and its powers along a straight edge, in closed form and without cancellation.

    L(n, k) = ∫_a^b wᵏ/(h² + w²)ⁿ dw,   n = 1, 2, 3,

h the distance of a point from the edge's line and w the position along it from the point's foot.
"""

from typing import NamedTuple

import numpy as np

from ..types import BoolArray, FloatArray

CONTACT = 1e-16  # distance of edges, relative to their length, below which they count as that far apart
_SERIES_TERMS = 14
_SERIES_LIMIT = 0.0625  # of (h/w)²: up to here series, above it closed forms; both to 1e-13


class Moments(NamedTuple):
    """L(1, 0), L(2, k) for k = 0, 1, 2 and, if asked for, L(3, k) for k = 0 … 4; all of one shape."""

    inverse: FloatArray
    square: tuple[FloatArray, ...]
    cube: tuple[FloatArray, ...]


def moments(h2: FloatArray, a: FloatArray, b: FloatArray, cubes: bool) -> Moments:
    """The moments for arrays h² ≥ 0 and a < b of one shape.

    A point on the edge counts as being 10⁻¹⁶ of the edge's length away, so that nothing is infinite.
    """
    h2 = np.maximum(h2, ((b - a) * CONTACT) ** 2)
    h = np.sqrt(h2)
    # if the foot is well outside the edge, nothing may be divided by h
    outside = a * b > h2
    safe_h2 = np.where(outside, 1.0, h2)
    a_out, b_out = np.where(outside, a, 1.0), np.where(outside, b, 2.0)
    x_a, x_b = np.where(outside, h / a_out, 0.0), np.where(outside, h / b_out, 0.0)
    ra2, rb2 = h2 + a * a, h2 + b * b

    inverse = _inverse_moment(h, h2, a, b, outside)
    edge = b / rb2 - a / ra2
    p_a, p_b = _tail_square(x_a), _tail_square(x_b)
    m0 = np.where(outside, p_a / a_out**3 - p_b / b_out**3, (inverse + edge) / (2.0 * safe_h2))
    m1 = 0.5 * (1.0 / ra2 - 1.0 / rb2)
    m2 = 0.5 * (inverse - edge)
    if not cubes:
        return Moments(inverse, (m0, m1, m2), ())
    edge = b / rb2**2 - a / ra2**2
    tails = _tail_cube(x_a, p_a) / a_out**5 - _tail_cube(x_b, p_b) / b_out**5
    c0 = np.where(outside, tails, (3.0 * m0 + edge) / (4.0 * safe_h2))
    c1 = 0.25 * (1.0 / ra2**2 - 1.0 / rb2**2)
    c2 = m0 - h2 * c0
    return Moments(inverse, (m0, m1, m2), (c0, c1, c2, m1 - h2 * c1, m2 - h2 * c2))


def _inverse_moment(h: FloatArray, h2: FloatArray, a: FloatArray, b: FloatArray, outside: BoolArray) -> FloatArray:
    """L(1, 0) = (arctan(b/h) − arctan(a/h))/h, the angle under which the edge is seen, over h."""
    width, scalar = b - a, h2 + a * b
    tangent = width * h / np.where(outside, scalar, 1.0)
    return np.where(
        outside,
        _arctan_ratio(np.where(outside, tangent, 0.0)) * width / np.where(outside, scalar, 1.0),
        np.arctan2(width * h, scalar) / np.where(outside, 1.0, h),
    )


def _arctan_ratio(x: FloatArray) -> FloatArray:
    """arctan(x)/x, also at 0."""
    small = np.abs(x) < 1e-8
    safe = np.where(small, 1.0, x)
    return np.where(small, 1.0, np.arctan(safe) / safe)


def _tail_square(x: FloatArray) -> FloatArray:
    """∫_1^∞ du/(x² + u²)² = (arctan x − x/(1 + x²))/(2x³) = 1/3 − 2x²/5 + 3x⁴/7 − …, also at 0."""
    x2 = x * x
    small = x2 < _SERIES_LIMIT
    safe = np.where(small, 1.0, x)
    series = _alternating(x2, [(k + 1) / (2 * k + 3) for k in range(_SERIES_TERMS)])
    return np.where(small, series, (np.arctan(safe) - safe / (1.0 + safe**2)) / (2.0 * safe**3))


def _tail_cube(x: FloatArray, tail_square: FloatArray) -> FloatArray:
    """∫_1^∞ du/(x² + u²)³ = (3 ∫_1^∞ du/(x² + u²)² − 1/(1 + x²)²)/(4x²) = 1/5 − 3x²/7 + 6x⁴/9 − …, also at 0."""
    x2 = x * x
    small = x2 < _SERIES_LIMIT
    safe = np.where(small, 1.0, x2)
    series = _alternating(x2, [(k + 1) * (k + 2) / (2 * (2 * k + 5)) for k in range(_SERIES_TERMS)])
    return np.where(small, series, (3.0 * tail_square - 1.0 / (1.0 + safe) ** 2) / (4.0 * safe))


def _alternating(y: FloatArray, coefficients: list[float]) -> FloatArray:
    """Σ (−1)ᵏ c_k yᵏ for 0 ≤ y < 1, by Horner's rule; larger y give finite numbers of no meaning."""
    y = np.minimum(y, 1.0)
    total = np.zeros_like(y)
    for c in reversed(coefficients):
        total = c - y * total
    return total
