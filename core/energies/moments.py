"""Moments of powers of 1/r² along a straight edge, in closed form and without cancellation.

    L(n, k) = ∫_a^b wᵏ/(h² + w²)ⁿ dw,   n = 1, 2,

h the distance of a point from the edge's line and w the position along it from the point's foot.
"""

import numpy as np
from numpy.polynomial.polynomial import polyval

from ..types import FloatArray
from .complex_steps import arctan2

CONTACT = 1e-16  # distance of edges, relative to their length, below which they count as that far apart
_SERIES = [(-1.0) ** k * (k + 1) / (2 * k + 3) for k in range(14)]  # of the tail, in powers of x²
_SERIES_LIMIT = 0.0625  # of x²: up to here the series, above it the closed form; both to 1e-13


def moments(h2: FloatArray, a: FloatArray, b: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """L(1, 0) and L(2, k) for k = 0, 1, 2; for arrays h² ≥ 0 and a < b of one shape.

    A point on the edge counts as being 10⁻¹⁶ of the edge's length away, so that nothing is infinite.
    """
    width = b - a
    h2 = np.maximum(h2, (width * CONTACT) ** 2)
    h = np.sqrt(h2)
    ra2, rb2 = h2 + a * a, h2 + b * b
    inverse = arctan2(width * h, h2 + a * b) / h
    edge = b / rb2 - a / ra2
    m0 = (inverse + edge) / (2.0 * h2)
    # if the foot is well outside the edge, differences that are divided by h cancel: there integrals from a and
    # from b to infinity take their place
    outside = a * b > h2
    inverse[outside], m0[outside] = _outside(h[outside], a[outside], b[outside])
    return inverse, m0, 0.5 * (1.0 / ra2 - 1.0 / rb2), 0.5 * (inverse - edge)


def _outside(h: FloatArray, a: FloatArray, b: FloatArray) -> tuple[FloatArray, FloatArray]:
    """L(1, 0), which is (arctan(h/a) − arctan(h/b))/h, by the addition theorem, and L(2, 0)."""
    across = (b - a) / (h * h + a * b)
    tangent = h * across
    small = np.abs(tangent) < 1e-8
    safe = np.where(small, 1.0, tangent)
    inverse = across * np.where(small, 1.0, arctan2(safe, np.ones_like(safe)) / safe)
    return inverse, _tail(h / a) / a**3 - _tail(h / b) / b**3


def _tail(x: FloatArray) -> FloatArray:
    """∫_1^∞ du/(x² + u²)² = (arctan x − x/(1 + x²))/(2x³) = 1/3 − 2x²/5 + 3x⁴/7 − …, also at 0."""
    x2 = x * x
    small = x2 < _SERIES_LIMIT
    safe = np.where(small, 1.0, x)
    closed = (arctan2(safe, np.ones_like(safe)) - safe / (1.0 + safe**2)) / (2.0 * safe**3)
    return np.where(small, polyval(np.where(small, x2, 0.0), _SERIES), closed)
