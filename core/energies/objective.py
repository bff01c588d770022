"""The objective that `relax` descends on: an energy, the barrier of its near pairs, and the repulsion of obstacles."""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import TypeVar, cast

import numpy as np

from ..arguments import checked_fields
from ..curve import Curve
from ..errors import OptionError
from ..obstacle import Obstacle
from ..types import FloatArray
from .barrier import Barrier
from .energy import Approximate, Energy, LocalTerm, Potential, Term, TwiceDifferentiable, WithMidpointPairs
from .moebius import MoebiusEnergy
from .near_pairs import replaced_pairs
from .repulsion import Repulsion

_Term = TypeVar("_Term", bound=Term)


@checked_fields
@dataclass(frozen=True)
class Objective:
    """A sum of terms: a C² function of the vertices, infinite where edges touch each other or an obstacle.

    Parameters
    ----------
    energy
        The energy of the curve alone, by default moebius.
    barrier
        What makes it infinite where edges touch.
    potentials
        What else acts on the curve, such as the repulsion of obstacles.
    """

    energy: Energy = field(default_factory=MoebiusEnergy)
    barrier: Barrier = field(default_factory=Barrier)
    potentials: tuple[Potential, ...] = ()

    name = "objective"
    description = "moebius + barrier + repulsion of obstacles, what relax descends on"

    @classmethod
    def of(cls, energy: Energy, obstacles: Iterable[Obstacle] = (), weight: float = 1.0) -> "Objective":
        """The objective of any energy among obstacles, in the units of curves, whose repulsion has some weight.

        The barrier takes the place of what the energy has of it, or stands beside it.
        """
        return cls(energy, Barrier(replaces_midpoint=energy.contains_midpoint_pairs), Repulsion.of(obstacles, weight))

    def frozen_at(self, curve: Curve) -> "Objective":
        """What a search from a curve should see: approximations that stay the same for all that is near."""
        energy, potentials = _frozen(self.energy, curve), tuple(_frozen(each, curve) for each in self.potentials)
        same = all(a is b for a, b in zip((energy, *potentials), (self.energy, *self.potentials), strict=True))
        return self if same else replace(self, energy=energy, potentials=potentials)

    def value(self, curve: Curve) -> float:
        """The objective at the curve."""
        energy, local = self._terms(curve)
        return sum(term.value(curve) for term in (energy, *local))

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        """The objective and its derivative with respect to the vertices, shape (n, m)."""
        energy, local = self._terms(curve)
        values = [term.value_and_derivative(curve) for term in (energy, *local)]
        return sum(value for value, _ in values), np.sum([derivative for _, derivative in values], axis=0)

    def hessian(self, curve: Curve) -> FloatArray:
        """Second derivative, symmetric, shape (n·m, n·m), in the order of ``vertices.ravel()``."""
        energy, local = self._terms(curve)
        matrix = self._twice_differentiable(energy).hessian(curve)
        for term in local:
            part = term.sparse_hessian(curve).tocoo()
            matrix[part.coords] += part.data
        return matrix

    def hessian_product(self, curve: Curve, v: FloatArray) -> FloatArray:
        """The second derivative times ``v`` of shape (n, m), without forming the matrix; shape (n, m)."""
        energy, local = self._terms(curve)
        product = self._twice_differentiable(energy).hessian_product(curve, v)
        return product + sum(term.hessian_product(curve, v) for term in local)

    def clearance(self, curve: Curve) -> FloatArray:
        """How far from each edge a wall would be that acts as the nearest potential does; shape (edges,)."""
        nowhere = np.full(curve.mesh.edges, np.inf)
        return np.asarray(np.min([nowhere, *(potential.clearance(curve) for potential in self.potentials)], axis=0))

    @property
    def has_hessian(self) -> bool:
        """Whether the energy comes with a second derivative."""
        return hasattr(self.energy, "hessian_product")

    def _terms(self, curve: Curve) -> tuple[Energy, tuple[LocalTerm, ...]]:
        """The energy and the other terms at a curve; what the barrier would take away of the energy is not even added.

        At a distance g the difference would be lost in some 1/g² times the rounding error of g.
        """
        if not self.barrier.replaces_midpoint:
            return self.energy, (self.barrier, *self.potentials)
        energy = cast(WithMidpointPairs, self.energy).leaving_out(replaced_pairs(curve))
        return energy, (replace(self.barrier, left_out=True), *self.potentials)

    def _twice_differentiable(self, energy: Energy) -> TwiceDifferentiable:
        if not self.has_hessian:
            raise OptionError(f"energy {self.energy.name!r} has no second derivative; choose another energy or method")
        return cast(TwiceDifferentiable, energy)


def _frozen(term: _Term, curve: Curve) -> _Term:
    return cast(_Term, term.frozen_at(curve)) if isinstance(term, Approximate) else term
