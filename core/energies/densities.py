"""The densities of energies, and the energies that quadrature rules make of them."""

from dataclasses import dataclass

import numpy as np

from ..base.arguments import checked
from ..base.errors import OptionError
from ..base.types import FloatArray
from .density import Partials, PointPairs
from .kpoint import KPointEnergy
from .quadrature import ENDS, MIDPOINT, TAIL, Rule


@dataclass(frozen=True)
class ArcDensity:
    """F = 1/r² − 1/ϱ², eq. (12) of [RS21], 1/r² between components; ∬ F is 4 for a circle, so nothing is added."""

    constant = 0.0
    scale_exponent = -2.0
    moebius_invariant = True

    def value(self, pairs: PointPairs) -> FloatArray:
        inverse = 1.0 / pairs.rho  # 0 between components; powers of a complex infinity are no numbers
        return 1.0 / pairs.r2 - inverse * inverse

    def derivative(self, pairs: PointPairs) -> Partials:
        inverse = 1.0 / pairs.rho
        return Partials(r2=-1.0 / (pairs.r2 * pairs.r2), rho=2.0 * inverse * inverse * inverse)


@dataclass(frozen=True)
class IshizekiNagasawaDensity:
    """F = (1 + ⟨τ_x, τ_y⟩ − 2 ⟨d, τ_x⟩⟨d, τ_y⟩/r²)/r² = (1 − cos α)/r² ≥ 0, so E = 4 + ∬ F on a closed curve."""

    constant = 4.0
    scale_exponent = -2.0
    moebius_invariant = True

    def value(self, pairs: PointPairs) -> FloatArray:
        s = 1.0 / pairs.r2
        return s * (1.0 + pairs.c - 2.0 * pairs.a * pairs.b * s)

    def derivative(self, pairs: PointPairs) -> Partials:
        s = 1.0 / pairs.r2
        s2 = s * s
        return Partials(
            r2=s2 * (4.0 * pairs.a * pairs.b * s - 1.0 - pairs.c), a=-2.0 * pairs.b * s2, b=-2.0 * pairs.a * s2, c=s
        )


VERTEX_ENERGY, EDGE_ENERGY = (
    KPointEnergy(
        name=name,
        description=f"{name} energy of Kusner and Sullivan: 1/r² − 1/ϱ² at the edges' {points}",
        density=ArcDensity(),
        rule=rule,
    )
    for name, points, rule in (("vertex", "tails", TAIL), ("edge", "midpoints", MIDPOINT))
)
"""One point per edge: R. Kusner and J. Sullivan, Möbius energies for knots and links (1997); Section 6.1.1 of [RS21].

On equilateral polygons the vertex energy Γ-converges to the Möbius energy: S. Scholtes, Discrete Möbius energy (2014).
"""


@checked
def moebius_kpoint(points: int) -> KPointEnergy:
    """The Möbius energy by the Gauss rule with ``points`` points per edge, eq. (40); OptionError below 1."""
    return KPointEnergy(
        name=f"moebius-k{points}",
        description=f"Möbius energy without arc distances, {points} Gauss points per edge",
        density=IshizekiNagasawaDensity(),
        rule=Rule.gauss(points),
    )


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
    """|d ∧ τ|², which rounding must not make negative; where it is 0, so is its derivative."""
    squared = pairs.r2 - along * along
    return np.where(squared.real > 0.0, squared, 0.0)


TANGENT_POINT_ENERGY = KPointEnergy(
    name="tangent-point",
    description="tangent-point energy with exponents 3 and 6, at the edges' end points",
    density=TangentPointDensity(),
    rule=ENDS,
)
