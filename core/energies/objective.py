"""The objective that `relax` descends on: an energy plus the barrier of its near pairs."""

from dataclasses import dataclass, field
from typing import cast

from ..curve import Curve
from ..errors import OptionError
from ..types import FloatArray
from .barrier import Barrier
from .energy import Energy, TwiceDifferentiable
from .moebius import MoebiusEnergy


@dataclass(frozen=True)
class Objective:
    """An energy, by default moebius, plus the barrier: a C² function of the vertices, infinite where edges touch."""

    energy: Energy = field(default_factory=MoebiusEnergy)
    barrier: Barrier = field(default_factory=Barrier)

    name = "objective"
    description = "moebius + barrier, what relax descends on"

    def value(self, curve: Curve) -> float:
        """The objective at the curve."""
        return self.energy.value(curve) + self.barrier.value(curve)

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        """The objective and its derivative with respect to the vertices, shape (n, m)."""
        energy, derivative = self.energy.value_and_derivative(curve)
        barrier, barrier_derivative = self.barrier.value_and_derivative(curve)
        return energy + barrier, derivative + barrier_derivative

    def hessian(self, curve: Curve) -> FloatArray:
        """Second derivative, symmetric, shape (n·m, n·m), in the order of ``vertices.ravel()``."""
        matrix = self._twice_differentiable().hessian(curve)
        near = self.barrier.sparse_hessian(curve).tocoo()
        matrix[near.coords] += near.data
        return matrix

    def hessian_product(self, curve: Curve, v: FloatArray) -> FloatArray:
        """The second derivative times ``v`` of shape (n, m), without forming the matrix; shape (n, m)."""
        return self._twice_differentiable().hessian_product(curve, v) + self.barrier.hessian_product(curve, v)

    @property
    def has_hessian(self) -> bool:
        """Whether the energy comes with a second derivative."""
        return hasattr(self.energy, "hessian_product")

    def _twice_differentiable(self) -> TwiceDifferentiable:
        if not self.has_hessian:
            raise OptionError(f"energy {self.energy.name!r} has no second derivative; choose another energy or method")
        return cast(TwiceDifferentiable, self.energy)
