"""The objective that `relax` descends on: an energy plus the barrier of its near pairs."""

from dataclasses import dataclass, field, replace
from typing import cast

import numpy as np

from ..curve import Curve
from ..errors import OptionError
from ..types import FloatArray
from .barrier import Barrier
from .energy import Approximate, Energy, TwiceDifferentiable, WithMidpointPairs
from .moebius import MoebiusEnergy
from .near_pairs import replaced_pairs


@dataclass(frozen=True)
class Objective:
    """An energy, by default moebius, plus the barrier: a C² function of the vertices, infinite where edges touch."""

    energy: Energy = field(default_factory=MoebiusEnergy)
    barrier: Barrier = field(default_factory=Barrier)

    name = "objective"
    description = "moebius + barrier, what relax descends on"

    @classmethod
    def of(cls, energy: Energy) -> "Objective":
        """The objective of any energy: the barrier takes the place of what it has of it, or stands beside it."""
        return cls(energy, Barrier(replaces_midpoint=energy.contains_midpoint_pairs))

    def frozen_at(self, curve: Curve) -> "Objective":
        """What a search from a curve should see: an approximation that stays the same for all that is near."""
        if not isinstance(self.energy, Approximate):
            return self
        energy = self.energy.frozen_at(curve)
        return self if energy is self.energy else replace(self, energy=energy)

    def value(self, curve: Curve) -> float:
        """The objective at the curve."""
        energy, barrier = self._parts(curve)
        return energy.value(curve) + barrier.value(curve)

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        """The objective and its derivative with respect to the vertices, shape (n, m)."""
        values = [part.value_and_derivative(curve) for part in self._parts(curve)]
        return sum(value for value, _ in values), np.sum([derivative for _, derivative in values], axis=0)

    def hessian(self, curve: Curve) -> FloatArray:
        """Second derivative, symmetric, shape (n·m, n·m), in the order of ``vertices.ravel()``."""
        energy, barrier = self._parts(curve)
        matrix = self._twice_differentiable(energy).hessian(curve)
        near = barrier.sparse_hessian(curve).tocoo()
        matrix[near.coords] += near.data
        return matrix

    def hessian_product(self, curve: Curve, v: FloatArray) -> FloatArray:
        """The second derivative times ``v`` of shape (n, m), without forming the matrix; shape (n, m)."""
        energy, barrier = self._parts(curve)
        return self._twice_differentiable(energy).hessian_product(curve, v) + barrier.hessian_product(curve, v)

    @property
    def has_hessian(self) -> bool:
        """Whether the energy comes with a second derivative."""
        return hasattr(self.energy, "hessian_product")

    def _parts(self, curve: Curve) -> tuple[Energy, Barrier]:
        """Energy and barrier at a curve; what the barrier would take away from near pairs is not even added.

        At a distance g the difference would be lost in some 1/g² times the rounding error of g.
        """
        if not self.barrier.replaces_midpoint:
            return self.energy, self.barrier
        return cast(WithMidpointPairs, self.energy).leaving_out(replaced_pairs(curve)), replace(
            self.barrier, left_out=True
        )

    def _twice_differentiable(self, energy: Energy) -> TwiceDifferentiable:
        if not self.has_hessian:
            raise OptionError(f"energy {self.energy.name!r} has no second derivative; choose another energy or method")
        return cast(TwiceDifferentiable, energy)
