"""The density that defines the Möbius energy, eq. (12) of [RS21]."""

from dataclasses import dataclass

from ..types import FloatArray
from .density import Partials, PointPairs


@dataclass(frozen=True)
class ArcDensity:
    """F = 1/r² − 1/ϱ², ϱ the distance along the curve; between components it is 1/r².

    ∬ F is 4 for a circle, so nothing is added to it.
    """

    constant = 0.0
    scale_exponent = -2.0
    moebius_invariant = True

    def value(self, pairs: PointPairs) -> FloatArray:
        """F of every pair."""
        return 1.0 / pairs.r2 - 1.0 / (pairs.rho * pairs.rho)

    def derivative(self, pairs: PointPairs) -> Partials:
        """The derivatives of F."""
        return Partials(r2=-1.0 / (pairs.r2 * pairs.r2), rho=2.0 / (pairs.rho * pairs.rho * pairs.rho))
