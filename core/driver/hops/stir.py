"""Stirring: one random flow of space after another carries the curve along, which folds it and turns it over."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...descent import Point, Step
from ...energies.components import energy_scale
from .pace import Field, Pace, between, radius

QUICK = Pace(stride=0.1, shortest=5e-3)


@dataclass(frozen=True)
class Stir:
    """Move along random flows, as nearly as edge lengths allow, up to a random multiple of the energy.

    A flow alone is an isotopy that leaves strands beside each other which were so before; one after the other they
    mix, and a higher ceiling lets the curve forget more of the minimum.  Distances are in radii of gyration.

    Parameters
    ----------
    flows
        Number of flows, one after the other.
    each
        That the curve moves by along each of them (root mean square over its vertices).
    pace
        Of its steps.
    waves
        Number of plane waves that a flow is the sum of.
    frequency
        Standard deviation of each component of their wave vectors, in radians per radius of gyration.
    ceilings
        Least and greatest multiple of the energy (of arcs, whose least is 0: of `energy_scale`) up to which the curve
        may be led.
    """

    flows: int = 10
    each: float = 1.0
    pace: Pace = QUICK
    waves: int = 4
    frequency: float = 2.0
    ceilings: tuple[float, float] = (2.0, 16.0)

    def fits(self, point: Point) -> bool:
        """Whether lengths are prescribed: else the curve would be stretched without end."""
        return point.problem.geometry.prescribes

    def __call__(self, point: Point, rng: np.random.Generator) -> Iterator[Step]:
        """Yield steps, each of which ends on the constraints."""
        ceiling = energy_scale(point.problem.mesh, point.energy) * between(self.ceilings, rng)
        for _ in range(self.flows):
            for step in self.pace.along(point, self._flow(point, rng), self.each, ceiling):
                yield step
                point = step.point.anchored

    def _flow(self, point: Point, rng: np.random.Generator) -> Field:
        """A sum of plane waves, each without divergence, most of them shorter than the curve is wide."""
        center = point.vertices.mean(axis=0)
        waves, amplitudes = rng.normal(size=(2, self.waves, point.curve.dimension))
        along = np.sum(waves * amplitudes, axis=1) / np.square(waves).sum(axis=1)
        amplitudes -= along[:, None] * waves
        waves *= self.frequency / radius(point.vertices)
        phases = rng.uniform(0.0, 2.0 * np.pi, self.waves)
        return lambda x: np.asarray(np.sin((x - center) @ waves.T + phases) @ amplitudes)
