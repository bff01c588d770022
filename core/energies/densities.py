"""The densities of [RS21], and the energies that quadrature rules make of them."""

from dataclasses import dataclass

from ..arguments import checked
from ..quadrature import MIDPOINT, TAIL, Rule
from ..types import FloatArray
from .density import Partials, PointPairs
from .kpoint import KPointEnergy


@dataclass(frozen=True)
class ArcDensity:
    """F = 1/r² − 1/ϱ², ϱ the distance along the curve, eq. (12) of [RS21]; between components it is 1/r².

    ∬ F is 4 for a circle, so nothing is added to it.
    """

    constant = 0.0
    scale_exponent = -2.0
    moebius_invariant = True

    def value(self, pairs: PointPairs) -> FloatArray:
        return 1.0 / pairs.r2 - 1.0 / (pairs.rho * pairs.rho)

    def derivative(self, pairs: PointPairs) -> Partials:
        return Partials(r2=-1.0 / (pairs.r2 * pairs.r2), rho=2.0 / (pairs.rho * pairs.rho * pairs.rho))


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
"""One point per edge (Section 6.1.1 of [RS21])."""


@checked
def moebius_kpoint(points: int) -> KPointEnergy:
    """The Möbius energy by the Gauss rule with ``points`` points per edge, eq. (40); OptionError below 1."""
    return KPointEnergy(
        name=f"moebius-k{points}",
        description=f"Möbius energy without arc distances, {points} Gauss points per edge",
        density=IshizekiNagasawaDensity(),
        rule=Rule.gauss(points),
    )
