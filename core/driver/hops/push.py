"""Pushing: the curve goes where it resists least, along soft modes."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...descent import Point, Step
from ...descent.soft_modes import soft_modes
from ...energies.components import energy_scale
from ...types import FloatArray
from .pace import Field, Pace, between

SLOW = Pace(stride=0.05, shortest=1e-3)  # where strands touch, only short steps are free


@dataclass(frozen=True)
class Push:
    """Move along a random combination of soft modes, look again which are soft, and so on, up to a level of energy.

    Where strands are about to touch, random flows press them together; a soft mode slides them along each other.

    Parameters
    ----------
    pushes
        Number of combinations, one after the other.
    each
        That the curve moves by along each of them (root mean square over its vertices, in radii of gyration).
    pace
        Of its steps.
    modes
        Number of modes in a combination.
    products
        With the Hessian, by which they are looked for: near enough then to be soft, they need be no nearer.  From a
        single start, of all rotations and other flat directions only one can be among them.
    ceilings
        Least and greatest multiple of the energy up to which the curve may be led.
    """

    pushes: int = 3
    each: float = 1.0
    pace: Pace = SLOW
    modes: int = 6
    products: int = 30
    ceilings: tuple[float, float] = (2.0, 16.0)

    def fits(self, point: Point) -> bool:
        """Whether lengths are prescribed, and the energy has a second derivative."""
        problem = point.problem
        return problem.geometry.prescribes and problem.objective.has_hessian

    def __call__(self, point: Point, rng: np.random.Generator) -> Iterator[Step]:
        """Yield steps, each of which ends on the constraints."""
        ceiling = energy_scale(point.problem.mesh, point.energy) * between(self.ceilings, rng)
        for _ in range(self.pushes):
            start = point.tangent_space.project(rng.normal(size=point.vertices.shape))
            modes = soft_modes(point, start[None], 0.0, -math.inf, self.products).vectors[: self.modes]
            field = _constant(np.tensordot(rng.normal(size=len(modes)), modes, 1))
            for step in self.pace.along(point, field, self.each, ceiling):
                yield step
                point = step.point.anchored


def _constant(u: FloatArray) -> Field:
    return lambda _: u
