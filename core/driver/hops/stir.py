"""Stirring: one random flow of space after another carries the curve along, which folds it and turns it over."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from ...descent import Leg, Point, Step
from ...descent.step import attempt
from ...energies.components import energy_scale
from ...types import FloatArray

RIGID = 1e-12  # part of a flow that is tangent, up to which it is rounding: pins may leave nothing to move

Flow = Callable[[FloatArray], FloatArray]


@dataclass(frozen=True)
class Stir:
    """Move along random flows, as nearly as edge lengths allow, up to a random multiple of the energy.

    A flow alone is an isotopy that leaves strands beside each other which were so before; one after the other they
    mix, and a higher ceiling lets the curve forget more of the minimum.  Distances are in radii of gyration.

    Parameters
    ----------
    distance
        That the curve moves by (root mean square over its vertices), all flows together.
    each
        The same of one flow.
    stride
        The same of one step, at most; where steps are not accepted they are halved.
    shortest
        Step at which a flow is given up.
    waves
        Number of plane waves that a flow is the sum of.
    frequency
        Standard deviation of each component of their wave vectors, in radians per radius of gyration.
    ceilings
        Least and greatest multiple of the energy (of arcs, whose least is 0: of `energy_scale`) up to which the curve
        may be led.
    """

    distance: float = 10.0
    each: float = 1.0
    stride: float = 0.1
    shortest: float = 5e-3
    waves: int = 4
    frequency: float = 2.0
    ceilings: tuple[float, float] = (2.0, 16.0)

    def fits(self, point: Point) -> bool:
        """Whether lengths are prescribed: else the curve would be stretched without end."""
        return point.problem.geometry.prescribes

    def __call__(self, point: Point, rng: np.random.Generator) -> Iterator[Step]:
        """Yield steps, each of which ends on the constraints."""
        ceiling = energy_scale(point.problem.mesh, point.energy) * _between(self.ceilings, rng)
        for _ in range(round(self.distance / self.each)):
            for step in self._along(self._flow(point, rng), point, ceiling):
                yield step
                point = step.point

    def _along(self, flow: Flow, point: Point, ceiling: float) -> Iterator[Step]:
        """Yield steps along one flow."""
        left, stride = self.each, self.stride
        while left > 0.0 and stride > self.shortest:
            velocity = flow(point.vertices)
            u = point.tangent_space.project(velocity)
            if _root_mean_square(u) <= RIGID * _root_mean_square(velocity):
                return
            u *= stride * _radius(point.vertices) / _root_mean_square(u)
            leg = attempt(point, point.vertices + u, 0.0 * point.residual, lambda end: end.energy < ceiling)
            if not isinstance(leg, Leg):
                stride *= 0.5
                continue
            yield Step((leg,), 0.0, None)
            point, left, stride = leg.end.anchored, left - stride, min(2.0 * stride, self.stride)

    def _flow(self, point: Point, rng: np.random.Generator) -> Flow:
        """A sum of plane waves, each without divergence, most of them shorter than the curve is wide."""
        center, radius = point.vertices.mean(axis=0), _radius(point.vertices)
        waves, amplitudes = rng.normal(size=(2, self.waves, point.curve.dimension))
        along = np.sum(waves * amplitudes, axis=1) / np.square(waves).sum(axis=1)
        amplitudes -= along[:, None] * waves
        waves *= self.frequency / radius
        phases = rng.uniform(0.0, 2.0 * np.pi, self.waves)
        return lambda x: np.asarray(np.sin((x - center) @ waves.T + phases) @ amplitudes)


def _between(bounds: tuple[float, float], rng: np.random.Generator) -> float:
    """A random number whose logarithm is evenly distributed."""
    return math.exp(rng.uniform(*np.log(bounds)))


def _radius(vertices: FloatArray) -> float:
    """Radius of gyration."""
    return _root_mean_square(vertices - vertices.mean(axis=0))


def _root_mean_square(u: FloatArray) -> float:
    return float(np.sqrt(np.square(u).sum(axis=1).mean()))
