"""The chain rule for quantities of a few variables with first and second derivatives, over many pairs at once."""

from dataclasses import dataclass

import numpy as np

from ..types import BoolArray, FloatArray


@dataclass(frozen=True, eq=False)
class Jet:
    """A quantity of k pairs of edges, its derivatives by c local variables, and their change along r directions.

    With r = c and the coordinate directions the change of the first derivatives is the matrix of second ones;
    with r = 1 it is the product of that matrix with a vector; r = 0 asks for first derivatives only.

    Attributes
    ----------
    value
        Shape (k,).
    first
        First derivatives, shape (k, c).
    along
        Derivatives along the directions, shape (k, r).
    second
        Derivatives of ``first`` along the directions, shape (k, c, r), or (1, c, r) if they are constant.
    """

    value: FloatArray
    first: FloatArray
    along: FloatArray
    second: FloatArray

    def __add__(self, other: "Jet") -> "Jet":
        return Jet(
            self.value + other.value, self.first + other.first, self.along + other.along, self.second + other.second
        )

    def __sub__(self, other: "Jet") -> "Jet":
        return self + other.scaled(-1.0)

    def __mul__(self, other: "Jet") -> "Jet":
        f, g = self.value[:, None], other.value[:, None]
        second = f[:, :, None] * other.second
        second += g[:, :, None] * self.second
        second += self.first[:, :, None] * other.along[:, None, :]
        second += other.first[:, :, None] * self.along[:, None, :]
        first, along = f * other.first + g * self.first, f * other.along + g * self.along
        return Jet(self.value * other.value, first, along, second)

    def scaled(self, factor: float) -> "Jet":
        """The quantity times a number."""
        return Jet(factor * self.value, factor * self.first, factor * self.along, factor * self.second)

    def where(self, kept: BoolArray) -> "Jet":
        """The quantity for some pairs, shape (k,), and 0 for the others, even if it is infinite there."""
        value, first = np.where(kept, self.value, 0.0), np.where(kept[:, None], self.first, 0.0)
        along, second = np.where(kept[:, None], self.along, 0.0), np.where(kept[:, None, None], self.second, 0.0)
        return Jet(value, first, along, second)

    def compose(self, value: FloatArray, slope: FloatArray, curvature: FloatArray) -> "Jet":
        """A function of the quantity, by its values and first and second derivatives there, each (k,)."""
        slope = slope[:, None]
        second = slope[:, :, None] * self.second
        second += (curvature[:, None] * self.first)[:, :, None] * self.along[:, None, :]
        return Jet(value, slope * self.first, slope * self.along, second)

    def sqrt(self) -> "Jet":
        """The square root."""
        root = np.sqrt(self.value)
        return self.compose(root, 0.5 / root, -0.25 / (root * self.value))

    def reciprocal(self) -> "Jet":
        """1 over the quantity."""
        inverse = 1.0 / self.value
        return self.compose(inverse, -(inverse**2), 2.0 * inverse**3)

    def log(self) -> "Jet":
        """The natural logarithm."""
        inverse = 1.0 / self.value
        return self.compose(np.log(self.value), inverse, -(inverse**2))
