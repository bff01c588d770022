"""N² and D of triangles and segments, polynomials in the vectors to their corners and in the lengths of these.

A solid angle Ω has tan(Ω/2) = N/D, an angle ψ between two vectors tan ψ = N/D.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from ...types import FloatArray
from ..moments import CONTACT
from .vectors import cross, dot, norm


class Form(Protocol):
    """N² and D as functions of a point x; arrays of numbers have one shape, those of vectors three of it."""

    @property
    def square(self) -> FloatArray:
        """N²; at contact it is what it is 10⁻¹⁶ of the simplex's size away."""

    @property
    def d(self) -> FloatArray:
        """D."""

    @property
    def slope_of_square(self) -> FloatArray:
        """∇N²."""

    @property
    def slope_of_d(self) -> FloatArray:
        """∇D."""

    def bend(self, v: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The derivatives of ∇N² and of ∇D along vectors v."""


@dataclass(frozen=True, eq=False)
class SegmentForm:
    """N = |a × b| and D = ⟨a, b⟩, for ends a and b seen from x."""

    a: FloatArray
    b: FloatArray

    @cached_property
    def _side(self) -> FloatArray:
        return self.b - self.a

    @cached_property
    def _normal(self) -> FloatArray:
        return cross(self.a, self._side)

    @property
    def square(self) -> FloatArray:
        """N²."""
        return np.maximum(dot(self._normal, self._normal), (CONTACT * dot(self._side, self._side)) ** 2)

    @property
    def d(self) -> FloatArray:
        """D."""
        return dot(self.a, self.b)

    @property
    def slope_of_square(self) -> FloatArray:
        """∇N² = −2 f × (a × f) with f = b − a."""
        return -2.0 * cross(self._side, self._normal)

    @property
    def slope_of_d(self) -> FloatArray:
        """∇D = −(a + b)."""
        return -(self.a + self.b)

    def bend(self, v: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The derivatives of ∇N² and of ∇D along vectors v."""
        return -2.0 * cross(self._side, cross(self._side, v)), 2.0 * v


@dataclass(frozen=True, eq=False)
class TriangleForm:
    """N = ⟨a, b × c⟩ and D = |a||b||c| + ⟨a, b⟩|c| + ⟨b, c⟩|a| + ⟨c, a⟩|b|, for corners a, b and c seen from x.

    ``normal`` is that of the triangle, twice its area long.
    """

    a: FloatArray
    b: FloatArray
    c: FloatArray
    normal: FloatArray

    @cached_property
    def _width(self) -> FloatArray:
        """The side of a square as large as two such triangles."""
        return np.sqrt(norm(self.normal))

    @cached_property
    def _n(self) -> FloatArray:
        return dot(self.normal, self.a)

    @cached_property
    def _lengths(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        a, b, c = (np.maximum(norm(corner), CONTACT * self._width) for corner in (self.a, self.b, self.c))
        return a, b, c

    @cached_property
    def _products(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """⟨b, c⟩, ⟨c, a⟩ and ⟨a, b⟩."""
        return dot(self.b, self.c), dot(self.c, self.a), dot(self.a, self.b)

    @property
    def square(self) -> FloatArray:
        """N²."""
        return np.maximum(self._n**2, (CONTACT * self._width**3) ** 2)

    @property
    def d(self) -> FloatArray:
        """D."""
        (ra, rb, rc), (bc, ca, ab) = self._lengths, self._products
        return np.asarray(ra * rb * rc + ab * rc + bc * ra + ca * rb)

    @property
    def slope_of_square(self) -> FloatArray:
        """∇N² = −2 N times the normal."""
        return -2.0 * self._n * self.normal

    @property
    def slope_of_d(self) -> FloatArray:
        """∇D, −Σ a ((|b||c| + ⟨b, c⟩)/|a| + |b| + |c|)."""
        (ra, rb, rc), (bc, ca, ab) = self._lengths, self._products
        slope = self.a * ((rb * rc + bc) / ra + rb + rc)
        slope += self.b * ((rc * ra + ca) / rb + rc + ra)
        slope += self.c * ((ra * rb + ab) / rc + ra + rb)
        return -slope

    def bend(self, v: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The derivatives of ∇N² and of ∇D along vectors v."""
        corners, lengths, products = (self.a, self.b, self.c), self._lengths, self._products
        rates = [-dot(corner, v) / length for corner, length in zip(corners, lengths, strict=True)]  # of lengths
        bend = np.zeros_like(self.a + v)
        for i, corner in enumerate(corners):
            j, k = (i + 1) % 3, (i + 2) % 3
            (r, s, t), (dr, ds, dt) = ([values[m] for m in (i, j, k)] for values in (lengths, rates))
            share = (s * t + products[i]) / r
            growth = ds * t + s * dt - dot(corners[j] + corners[k], v) - share * dr
            bend += (share + s + t) * v - (growth / r + ds + dt) * corner
        return 2.0 * dot(self.normal, v) * self.normal, bend
