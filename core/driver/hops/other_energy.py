"""Down another energy's slope for a while: its minima are elsewhere."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from ...descent import METHODS, Point, State, Step
from ...energies import ENERGIES, Objective

MOST_VERTICES = 5000


@dataclass(frozen=True)
class OtherEnergy:
    """Descend on another energy, with the barrier, by the paper's method that is fastest.

    Parameters
    ----------
    name
        Of the energy, in the registry.
    steps
        Number of steps.
    """

    name: str
    steps: int = 100

    def fits(self, point: Point) -> bool:
        """Whether sums over all pairs of edges are fast enough."""
        return len(point.vertices) <= MOST_VERTICES

    def __call__(self, point: Point, rng: np.random.Generator) -> Iterator[Step]:
        """Yield the steps; nothing is left to chance but how many there are."""
        rule, memory = METHODS["lbfgs"].rule, State()
        here = point.within(replace(point.problem, objective=Objective.of(ENERGIES[self.name])))
        for _ in range(int(rng.integers(self.steps // 2, self.steps, endpoint=True))):
            step, memory = rule.step(here, memory)
            if not isinstance(step, Step):
                return
            yield step
            here = step.point.anchored
