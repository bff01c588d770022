"""The tangent-point energy of Buck and Orloff: another self-avoiding energy in the same frame.

Its density is |d ∧ τ_x|^α / r^β, the area between chord and tangent in place of the chord's inverse square; for
β = 2 α it is a power of the radius of the circle through y that touches the curve at x.  Discretised as by
Yu, Schumacher and Crane (Repulsive Curves, 2021): the mean over the end points of both edges.
"""

from dataclasses import dataclass

import numpy as np

from ..errors import OptionError
from ..quadrature import ENDS
from ..types import FloatArray
from .density import Partials, PointPairs
from .kpoint import KPointEnergy


@dataclass(frozen=True)
class TangentPointDensity:
    """F = ½ (|d ∧ τ_x|^α + |d ∧ τ_y|^α)/r^β, with |d ∧ τ|² = r² − ⟨d, τ⟩².

    OptionError unless α ≥ 2 and α + 2 ≤ β < 2 α + 1: strong enough to keep strands apart, finite for smooth curves.
    """

    alpha: float = 3.0
    beta: float = 6.0

    constant = 0.0

    @property
    def scale_exponent(self) -> float:
        return self.alpha - self.beta

    def __post_init__(self) -> None:
        if not self.alpha >= 2.0:
            raise OptionError(f"alpha is {self.alpha}; it must be 2 or more")
        if not self.alpha + 2.0 <= self.beta < 2.0 * self.alpha + 1.0:
            raise OptionError(f"beta is {self.beta}; it must be from alpha + 2 to below 2 alpha + 1")

    def value(self, pairs: PointPairs) -> FloatArray:
        power = 0.5 * self.alpha
        heights = _squared_height(pairs, pairs.a) ** power + _squared_height(pairs, pairs.b) ** power
        return np.asarray(0.5 * heights * pairs.r2 ** (-0.5 * self.beta))

    def derivative(self, pairs: PointPairs) -> Partials:
        power, decay = 0.5 * self.alpha, pairs.r2 ** (-0.5 * self.beta)
        height_a, height_b = _squared_height(pairs, pairs.a), _squared_height(pairs, pairs.b)
        slope_a = (0.5 * power) * height_a ** (power - 1.0) * decay
        slope_b = (0.5 * power) * height_b ** (power - 1.0) * decay
        heights = height_a**power + height_b**power
        return Partials(
            r2=slope_a + slope_b - (0.25 * self.beta) * heights * decay / pairs.r2,
            a=-2.0 * pairs.a * slope_a,
            b=-2.0 * pairs.b * slope_b,
        )


def _squared_height(pairs: PointPairs, along: FloatArray) -> FloatArray:
    """|d ∧ τ|², which rounding must not make negative."""
    return np.maximum(pairs.r2 - along * along, 0.0)


TANGENT_POINT_ENERGY = KPointEnergy(
    name="tangent-point",
    description="tangent-point energy with exponents 3 and 6, at the edges' end points",
    density=TangentPointDensity(),
    rule=ENDS,
)
