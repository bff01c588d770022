"""The objective that `relax` descends on: an energy plus the barrier of its near pairs."""

from dataclasses import dataclass

from ..curve import Curve
from ..types import FloatArray
from .barrier import Barrier
from .moebius import MoebiusEnergy


@dataclass(frozen=True)
class Objective:
    """moebius + barrier, a C² function of the vertices that is infinite where edges touch."""

    energy: MoebiusEnergy = MoebiusEnergy()
    barrier: Barrier = Barrier()

    def value(self, curve: Curve) -> float:
        """The objective at the curve."""
        return self.energy.value(curve) + self.barrier.value(curve)

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        """The objective and its derivative with respect to the vertices, shape (n, m)."""
        energy, derivative = self.energy.value_and_derivative(curve)
        barrier, barrier_derivative = self.barrier.value_and_derivative(curve)
        return energy + barrier, derivative + barrier_derivative
