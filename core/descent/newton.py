"""The quadratic end of a descent: L-BFGS with the inverse of the Lagrangian's Hessian in place of that of the metric.

Near a minimum J_C⁻¹ D²L has a few eigenvalues far below its bulk, those of Möbius maps being some 11/N²: in the metric
hundreds of steps crawl along their valleys.  With a multiple of the metric that makes it positive definite on the
tangent space, D²L + σ J_C is assembled, which is as dear as a few steps, and factorised; the next steps share it, and
the pairs of L-BFGS tell what changes on the way.  Newton's method it is where one step suffices.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from ..arguments import checked_fields, number
from ..deadline import check_time
from ..energies.energy import Approximate
from ..saddle.indefinite import Chains, FactorisedHessian
from .directions import LimitedMemoryBFGS
from .hessian import ASSEMBLED_SIZE, lagrangian_matrix
from .problem import Point
from .searches import Armijo, LineSearch
from .step import State, Step

_LARGEST = 1e6  # σ; that of a Hessian whose steps are those of the metric is 1


class Curvature:
    """The Lagrangian's second derivative at a point, on the tangent space, against the metric there.

    Under a symmetry it is the metric on all directions that break it, so that they neither count nor are gone.
    """

    def __init__(self, point: Point) -> None:
        check_time()
        self.point, self._chains = point, Chains(point.tangent_space.constraints)
        gram = point.inner_product.dense()
        hessian = self.point.problem.constraints.symmetry.within(lagrangian_matrix(point), gram)
        self._hessian, self._metric = self._chains.of_hessian(hessian), self._chains.of_metric(gram)

    @staticmethod
    def is_known(point: Point) -> bool:
        """Whether there is one, exact and small enough to be factorised."""
        objective = point.problem.objective
        exact = objective.has_hessian and not isinstance(objective.energy, Approximate)
        return exact and point.problem.geometry.prescribes and point.vertices.size <= ASSEMBLED_SIZE

    def shifted(self, shift: float) -> FactorisedHessian:
        """D²L + σ J for a shift σ; as many of its eigenvalues are negative as D²L has below −σ against J."""
        check_time()
        return FactorisedHessian(self._hessian + shift * self._metric, self._chains)

    def gain(self, inverse: FactorisedHessian) -> float:
        """The decrease of the energy that a quadratic model promises, half the square of Newton's decrement."""
        return 0.5 * float(np.sum(self.point.derivative * inverse.solve(self.point.derivative)))


@checked_fields
@dataclass(frozen=True)
class Newton:
    """Steps that share one second derivative."""

    factor: float = number(8.0, above=1)  # by which σ grows until the Hessian is positive definite
    steps: int = number(8)
    short: float = number(0.3, most=1)  # part of a step that shows that the model is not to be trusted so far
    # full steps gain half of what their slope promises, and so must not be asked for that
    search: Armijo = field(default_factory=lambda: Armijo(decrease=0.1))

    def definite(self, curvature: Curvature, shift: float) -> tuple[FactorisedHessian, int, float]:
        """The factors for the first σ, from a given one on, that makes it so, the index at the given one, and σ.

        Raises LinAlgError if none does, which rounding alone can bring about.
        """
        inverse = curvature.shifted(shift)
        index = inverse.negative
        while inverse.negative:
            shift *= self.factor
            if not shift < _LARGEST:
                raise np.linalg.LinAlgError("no multiple of the metric makes the second derivative definite")
            inverse = curvature.shifted(shift)
        return inverse, index, shift

    def along(
        self, curvature: Curvature, inverse: FactorisedHessian, shift: float, most: int, least: float
    ) -> Iterator[Step]:
        """At most so many steps, until one gains less than ``least`` or none is found; where one is short σ grows."""
        point, state = curvature.point, State()
        for _ in range(min(most, self.steps)):
            rule = LineSearch(LimitedMemoryBFGS(inverse=inverse.solve), self.search, self.steps)
            step, state = rule.step(point, state)
            if not isinstance(step, Step):
                return
            yield step
            if point.energy - step.point.energy < least:
                return
            point = step.point
            if step.size < self.short:
                inverse, _, shift = self.definite(curvature, self.factor * shift)
                state = State()
