"""The default energy with more than one Gauss point per edge, eq. (40) of [RS21]."""

from dataclasses import dataclass

from ..arguments import checked
from ..quadrature import Rule
from ..types import FloatArray
from .density import Partials, PointPairs
from .kpoint import KPointEnergy


@dataclass(frozen=True)
class IshizekiNagasawaDensity:
    """F = (1 + ⟨τ_x, τ_y⟩ − 2 ⟨d, τ_x⟩⟨d, τ_y⟩/r²)/r² = (1 − cos α)/r² ≥ 0, so E = 4 + ∬ F on a closed curve."""

    constant = 4.0
    scale_exponent = -2.0
    moebius_invariant = True

    def value(self, pairs: PointPairs) -> FloatArray:
        """F of every pair."""
        s = 1.0 / pairs.r2
        return s * (1.0 + pairs.c - 2.0 * pairs.a * pairs.b * s)

    def derivative(self, pairs: PointPairs) -> Partials:
        """The derivatives of F."""
        s = 1.0 / pairs.r2
        s2 = s * s
        return Partials(
            r2=s2 * (4.0 * pairs.a * pairs.b * s - 1.0 - pairs.c),
            a=-2.0 * pairs.b * s2,
            b=-2.0 * pairs.a * s2,
            c=s,
        )


@checked
def moebius_kpoint(points: int) -> KPointEnergy:
    """The Möbius energy by the Gauss rule with ``points`` points per edge; OptionError below 1."""
    return KPointEnergy(
        name=f"moebius-k{points}",
        description=f"Möbius energy without arc distances, {points} Gauss points per edge",
        density=IshizekiNagasawaDensity(),
        rule=Rule.gauss(points),
    )
