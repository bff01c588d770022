"""Stirring: a random flow of the space carries the curve along."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from ...descent import Leg, Point, Step
from ...descent.step import attempt
from ...types import FloatArray

Field = Callable[[FloatArray], FloatArray]


@dataclass(frozen=True)
class Stir:
    """Move along a smooth random field, which is that of an isotopy, as far as lengths can be kept."""

    waves: int = 8
    distance: float = 2.0
    stride: float = 0.1
    shortest: float = 1e-3
    ceiling: float = 3.0

    def fits(self, point: Point) -> bool:
        """Always."""
        return True

    def __call__(self, point: Point, rng: np.random.Generator) -> Iterator[Step]:
        """Yield the steps."""
        field, level = self._field(point, rng), 0.0 * point.residual
        radius = float(np.sqrt(np.square(point.vertices - point.vertices.mean(axis=0)).sum(axis=1).mean()))
        ceiling = self.ceiling * point.energy
        left, stride = self.distance, self.stride
        while left > 0.0 and stride > self.shortest:
            u = point.tangent_space.project(field(point.vertices))
            u *= stride * radius / np.sqrt(np.square(u).sum(axis=1).mean())
            leg = attempt(point, point.vertices + u, level, lambda end: end.energy < ceiling)
            if not isinstance(leg, Leg):
                stride *= 0.5
                continue
            yield Step((leg,), 0.0, None)
            point, left, stride = leg.end.anchored, left - stride, min(2.0 * stride, self.stride)

    def _field(self, point: Point, rng: np.random.Generator) -> Field:
        x = point.vertices
        center, radius = x.mean(axis=0), float(np.sqrt(np.square(x - x.mean(axis=0)).sum(axis=1).mean()))
        waves, amplitude = rng.normal(size=(2, self.waves, x.shape[1]))
        amplitude -= waves * (np.sum(waves * amplitude, axis=1) / np.square(waves).sum(axis=1))[:, None]
        waves /= radius
        phase = rng.uniform(0.0, 2.0 * np.pi, self.waves)
        return lambda points: np.sin((points - center) @ waves.T + phase) @ amplitude
