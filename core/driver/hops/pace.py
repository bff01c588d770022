"""Moving along a field of directions: proved steps of bounded length, on the constraints, up to a level of energy."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from ...descent import Leg, Point, Step
from ...descent.step import attempt
from ...types import FloatArray

RIGID = 1e-12  # part of a field that is tangent, up to which it is rounding: pins may leave nothing to move

Field = Callable[[FloatArray], FloatArray]
"""Velocities at vertices; shapes (n, m) -> (n, m)."""


@dataclass(frozen=True)
class Pace:
    """How far one step goes: root mean squares over the vertices, in radii of gyration.

    Parameters
    ----------
    stride
        Of a step, at most; where steps are not accepted they are halved.
    shortest
        Step at which a direction is given up.
    """

    stride: float
    shortest: float

    def along(self, point: Point, field: Field, distance: float, ceiling: float) -> Iterator[Step]:
        """Yield steps, each of which ends on the constraints and below a level of energy."""
        left, stride = distance, self.stride
        while left > 0.0 and stride > self.shortest:
            velocity = field(point.vertices)
            u = point.tangent_space.project(velocity)
            if root_mean_square(u) <= RIGID * root_mean_square(velocity):
                return
            u *= stride * radius(point.vertices) / root_mean_square(u)
            leg = attempt(point, point.vertices + u, 0.0 * point.residual, lambda end: end.energy < ceiling)
            if not isinstance(leg, Leg):
                stride *= 0.5
                continue
            yield Step((leg,), 0.0, None)
            point, left, stride = leg.end.anchored, left - stride, min(2.0 * stride, self.stride)


def between(bounds: tuple[float, float], rng: np.random.Generator) -> float:
    """A random number whose logarithm is evenly distributed."""
    return math.exp(rng.uniform(*np.log(bounds)))


def radius(vertices: FloatArray) -> float:
    """Radius of gyration."""
    return root_mean_square(vertices - vertices.mean(axis=0))


def root_mean_square(u: FloatArray) -> float:
    """Of the lengths of vectors; shape (n, m)."""
    return float(np.sqrt(np.square(u).sum(axis=1).mean()))
