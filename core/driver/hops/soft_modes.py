"""A push along the soft modes of the Hessian."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...descent import Leg, Point, Step
from ...descent.step import attempt
from ..stability import stability

MOST_UNKNOWNS = 4000


@dataclass(frozen=True)
class SoftModes:
    """Go on and on in a random direction among the softest ones."""

    count: int = 20
    distance: float = 30.0
    stride: float = 0.5
    shortest: float = 1e-2
    ceiling: float = 1.5

    def fits(self, point: Point) -> bool:
        """Whether there is a second derivative, and room and time for dense matrices."""
        problem = point.problem
        return problem.geometry.prescribes and problem.objective.has_hessian and point.vertices.size <= MOST_UNKNOWNS

    def __call__(self, point: Point, rng: np.random.Generator) -> Iterator[Step]:
        """Yield the steps."""
        modes = stability(point, self.count)
        stiff = np.abs(modes.eigenvalues) > 1e-5
        weights = rng.normal(size=stiff.sum()) / np.sqrt(np.abs(modes.eigenvalues[stiff]))
        u = np.tensordot(weights, modes.directions[stiff], 1)
        ceiling, level = self.ceiling * point.energy, 0.0 * point.residual
        left, stride = self.distance, self.stride
        while left > 0.0 and stride > self.shortest:
            u = point.transport(u)
            u /= point.tangent_space.norm(u)
            leg = attempt(point, point.vertices + stride * u, level, lambda end: end.energy < ceiling)
            if not isinstance(leg, Leg):
                stride *= 0.5
                continue
            yield Step((leg,), 0.0, None)
            point, left, stride = leg.end.anchored, left - stride, min(2.0 * stride, self.stride)
