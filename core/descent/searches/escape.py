"""A step away from a saddle, along a direction of negative curvature."""

import math
from dataclasses import dataclass, field
from functools import partial

from ...checks import check_fields
from ...types import FloatArray
from ..problem import Point
from ..step import Leg, NoStep, Step, attempt
from .first_trial import FirstTrial


@dataclass(frozen=True)
class Escape:
    """Halve a step along ± a direction of negative curvature until it lowers the energy and is proved.

    Parameters
    ----------
    decrease
        Required fraction of the predicted decrease.
    longest
        First step, in the metric's norm.
    first
        The first trial.
    max_trials
        Number of trials each way.
    """

    decrease: float = 0.1
    longest: float = 0.5
    first: FirstTrial = field(default_factory=FirstTrial)
    max_trials: int = 20

    def __post_init__(self) -> None:
        check_fields(self, decrease=(0.0, 1.0), longest=(0.0, math.inf), max_trials=(0, math.inf))

    def step(self, point: Point, direction: FloatArray, curvature: float) -> Step | NoStep:
        """Find a step with E(Q) < E(P) + ½ c τ² curvature, c the required decrease.

        Parameters
        ----------
        direction
            Tangent vector of length 1 in the metric; shape (n, m).
        curvature
            ⟨direction, D²L direction⟩ < 0.
        """
        limited_by = None
        for sign in (1.0, -1.0):
            tau, limited_by = self.first(point, sign * direction, self.longest)
            for _ in range(self.max_trials):
                vertices, level = point.vertices + sign * tau * direction, 0.0 * point.residual
                trial = attempt(point, vertices, level, partial(self.sufficient, point, 0.5 * curvature * tau**2))
                if isinstance(trial, Leg):
                    return Step((trial,), tau, limited_by)
                limited_by = trial.in_the_way or limited_by
                tau *= 0.5
        return NoStep.because(limited_by)

    def sufficient(self, point: Point, predicted: float, trial: Point) -> bool:
        """Whether the energy goes down by enough of what is predicted, a negative number."""
        return trial.energy < point.energy + self.decrease * predicted
