"""An energy: 1/r³ at the edges' midpoints."""

from dataclasses import dataclass

from ..base.types import FloatArray
from .density import Partials, PointPairs
from .kpoint import KPointEnergy
from .quadrature import MIDPOINT


@dataclass(frozen=True)
class InverseCube:
    """F = 1/r³."""

    constant = 0.0
    scale_exponent = -3.0

    def value(self, pairs: PointPairs) -> FloatArray:
        """F of every pair."""
        return pairs.r2**-1.5

    def derivative(self, pairs: PointPairs) -> Partials:
        """Its derivative by r²."""
        return Partials(r2=-1.5 * pairs.r2**-2.5)


INVERSE_CUBE = KPointEnergy("inverse-cube", "1/r³ at the edges' midpoints", InverseCube(), MIDPOINT)
