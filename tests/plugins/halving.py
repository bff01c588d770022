"""A search: halve the step until the energy goes down, on the level of the constraints where the curve is."""

from dataclasses import dataclass, field

import numpy as np

from ..base.types import FloatArray
from .line_searches import FirstTrial
from .problem import Point
from .step import Leg, NoStep, Step, attempt


@dataclass(frozen=True)
class Halving:
    """Armijo's rule without anything else."""

    decrease: float = 0.1
    first: FirstTrial = field(default_factory=FirstTrial)
    max_trials: int = 30

    def along(self, point: Point, direction: FloatArray, natural: float, last: float) -> Step | NoStep:
        """Find a step along a descent direction."""
        tau, limited_by = self.first(point, direction, min(natural, self.first.growth * last))
        slope = self.decrease * float(np.sum(point.derivative * direction))
        for size in tau * 0.5 ** np.arange(self.max_trials):
            bound = point.energy + size * slope
            move = point.vertices + size * direction
            trial = attempt(point, move, point.residual, lambda reached, bound=bound: reached.energy <= bound)
            if isinstance(trial, Leg):
                return Step((trial,), float(size), limited_by)
        return NoStep.because(limited_by)
