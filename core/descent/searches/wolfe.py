"""A weak Wolfe–Powell search, which the infeasible methods of Section 6.4 of [RS21] use.

Bisection after Lewis and Overton (Nonsmooth optimization via quasi-Newton methods, 2013): it needs no more than the
two conditions and ends for every function that is bounded below.
"""

import math
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from ...checks import check_fields
from ...errors import OptionError
from ...types import FloatArray
from ..problem import Point
from ..step import Leg, NoStep, Step, attempt
from .armijo import ROUNDING, Armijo
from .first_trial import NOTHING, FirstTrial
from .normal_step import on_target


@dataclass(frozen=True)
class WeakWolfe:
    """Widen or halve a bracket until the energy goes down enough and its slope has become flat enough.

    Parameters
    ----------
    decrease, curvature
        c₁ < c₂ of the two conditions.
    first
        The first trial.
    underway
        The search on the way to target lengths, where these are prescribed.
    max_trials
        Number of trials.
    """

    decrease: float = 1e-4
    curvature: float = 0.9
    first: FirstTrial = field(default_factory=FirstTrial)
    underway: Armijo = field(default_factory=Armijo)
    max_trials: int = 40

    def __post_init__(self) -> None:
        check_fields(self, decrease=(0.0, 1.0), curvature=(0.0, 1.0), max_trials=(0, math.inf))
        if self.decrease >= self.curvature:
            raise OptionError(f"decrease is {self.decrease}; it must be less than curvature, {self.curvature}")

    def along(self, point: Point, direction: FloatArray, natural: float, last: float) -> Step | NoStep:
        """Find a step with E(Q) ≤ E(P) + c₁ τ DE·d and DE(Q)·d ≥ c₂ DE(P)·d, d moved along to Q.

        If contact ends the line before the second condition holds, the longest step found is taken.  Parameters are
        those of `Armijo.along`.
        """
        if not on_target(point):
            return self.underway.along(point, direction, natural, last)
        end, limited_by = self.first(point, direction, math.inf)
        slope = float(np.sum(point.derivative * direction))
        low, high = 0.0, math.inf
        best: Step | None = None
        tau = min(natural, self.first.growth * last if math.isfinite(last) else 1.0, end)
        for _ in range(self.max_trials):
            if not tau * np.max(np.abs(direction)) > NOTHING:
                break
            acceptable = partial(self.sufficient, point, tau * slope)
            trial = attempt(point, point.vertices + tau * direction, point.residual, acceptable)
            if isinstance(trial, Leg):
                best, low = Step((trial,), tau, limited_by), tau
                if self.flat(trial.end, direction, slope) or tau >= end:
                    break
            else:
                high, limited_by = tau, trial.in_the_way or limited_by
            tau = min(end, 2.0 * low) if math.isinf(high) else 0.5 * (low + high)
        return NoStep.because(limited_by) if best is None else best

    def sufficient(self, point: Point, slope: float, trial: Point) -> bool:
        """The condition on the energy; differences below its rounding count as none."""
        return trial.energy <= point.energy + self.decrease * slope + ROUNDING * abs(point.energy)

    def flat(self, trial: Point, direction: FloatArray, slope: float) -> bool:
        """The condition on the slope at the end."""
        return float(np.sum(trial.derivative * trial.transport(direction))) >= self.curvature * slope
