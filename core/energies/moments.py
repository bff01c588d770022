"""Moments of 1/r² and its powers along a straight edge, in closed form and without cancellation.

    L(n, k) = ∫_a^b wᵏ/(h² + w²)ⁿ dw,   n = 1, 2, 3,

h the distance of a point from the edge's line and w the position along it from the point's foot.
"""

from typing import NamedTuple

import numpy as np

from ..types import FloatArray

CONTACT = 1e-16  # distance of edges, relative to their length, below which they count as that far apart
_SERIES_TERMS = 14
_SERIES_LIMIT = 0.0625  # of (h/w)²: up to here series, above it closed forms; both to 1e-13


class Moments(NamedTuple):
    """L(1, 0), L(2, k) for k = 0, 1, 2 and, on demand, L(3, k) for k = 0 … 4; all of one shape."""

    inverse: FloatArray
    square: tuple[FloatArray, ...]
    cube: tuple[FloatArray, ...]


def moments(h2: FloatArray, a: FloatArray, b: FloatArray, cubes: bool) -> Moments:
    """The moments for arrays h² ≥ 0 and a < b of one shape.

    A point on the edge counts as being 10⁻¹⁶ of the edge's length away, so that nothing is infinite.
    """
    width = b - a
    h2 = np.maximum(h2, (width * CONTACT) ** 2)
    h = np.sqrt(h2)
    ra2, rb2 = h2 + a * a, h2 + b * b
    # if the foot is well outside the edge, differences that are divided by h cancel: there integrals from a and
    # from b to infinity take their place
    outside = a * b > h2
    tails = _Tails.of(h[outside], a[outside], b[outside])

    inverse = np.arctan2(width * h, h2 + a * b) / h
    inverse[outside] = tails.inverse()
    edge = b / rb2 - a / ra2
    m0 = (inverse + edge) / (2.0 * h2)
    m0[outside] = tails.square()
    square = (m0, 0.5 * (1.0 / ra2 - 1.0 / rb2), 0.5 * (inverse - edge))
    if not cubes:
        return Moments(inverse, square, ())
    c0 = (3.0 * m0 + b / rb2**2 - a / ra2**2) / (4.0 * h2)
    c0[outside] = tails.cube()
    c1 = 0.25 * (1.0 / ra2**2 - 1.0 / rb2**2)
    c2 = m0 - h2 * c0
    return Moments(inverse, square, (c0, c1, c2, square[1] - h2 * c1, square[2] - h2 * c2))


class _Tails(NamedTuple):
    """L(n, 0) where a and b have one sign and a b > h²; arrays of one dimension."""

    h: FloatArray
    a: FloatArray
    b: FloatArray
    square_a: FloatArray  # a³ ∫_a^∞ dw/(h² + w²)²
    square_b: FloatArray

    @classmethod
    def of(cls, h: FloatArray, a: FloatArray, b: FloatArray) -> "_Tails":
        return cls(h, a, b, tail_square(h / a), tail_square(h / b))

    def inverse(self) -> FloatArray:
        """arctan(h/a) − arctan(h/b) over h, by the addition theorem."""
        across = (self.b - self.a) / (self.h * self.h + self.a * self.b)
        tangent = self.h * across
        small = np.abs(tangent) < 1e-8
        safe = np.where(small, 1.0, tangent)
        return np.asarray(across * np.where(small, 1.0, np.arctan(safe) / safe))

    def square(self) -> FloatArray:
        return self.square_a / self.a**3 - self.square_b / self.b**3

    def cube(self) -> FloatArray:
        tail_a, tail_b = tail_cube(self.h / self.a, self.square_a), tail_cube(self.h / self.b, self.square_b)
        return tail_a / self.a**5 - tail_b / self.b**5


def tail_square(x: FloatArray) -> FloatArray:
    """∫_1^∞ du/(x² + u²)² = (arctan x − x/(1 + x²))/(2x³) = 1/3 − 2x²/5 + 3x⁴/7 − …, also at 0."""
    x2 = x * x
    small = x2 < _SERIES_LIMIT
    safe = np.where(small, 1.0, x)
    series = _alternating(x2, [(k + 1) / (2 * k + 3) for k in range(_SERIES_TERMS)])
    return np.where(small, series, (np.arctan(safe) - safe / (1.0 + safe**2)) / (2.0 * safe**3))


def tail_cube(x: FloatArray, square: FloatArray) -> FloatArray:
    """∫_1^∞ du/(x² + u²)³ = (3 ∫_1^∞ du/(x² + u²)² − 1/(1 + x²)²)/(4x²) = 1/5 − 3x²/7 + 6x⁴/9 − …, also at 0."""
    x2 = x * x
    small = x2 < _SERIES_LIMIT
    safe = np.where(small, 1.0, x2)
    series = _alternating(x2, [(k + 1) * (k + 2) / (2 * (2 * k + 5)) for k in range(_SERIES_TERMS)])
    return np.where(small, series, (3.0 * square - 1.0 / (1.0 + safe) ** 2) / (4.0 * safe))


def _alternating(y: FloatArray, coefficients: list[float]) -> FloatArray:
    """Σ (−1)ᵏ c_k yᵏ for 0 ≤ y < 1, by Horner's rule; larger y give finite numbers of no meaning."""
    y = np.minimum(y, 1.0)
    total = np.zeros_like(y)
    for c in reversed(coefficients):
        total = c - y * total
    return total
