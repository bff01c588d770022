"""What the infeasible methods of Section 6.4 of [RS21] use: a weak Wolfe–Powell search, and Nesterov's steps."""

import math
from dataclasses import dataclass, field, replace
from functools import partial
from typing import ClassVar

import numpy as np

from ...arguments import checked_fields, number
from ...errors import OptionError
from ...metrics import Metric
from ...types import FloatArray
from ..problem import Point
from ..step import Leg, NoStep, Rejected, State, Step, attempt
from .armijo import NOTHING, ROUNDING, Armijo, FirstTrial, on_target


@checked_fields
@dataclass(frozen=True)
class WeakWolfe:
    """Widen or halve a bracket until the energy goes down enough and its slope has become flat enough.

    Bisection after Lewis and Overton (Nonsmooth optimization via quasi-Newton methods, 2013): it needs no more than the
    two conditions and ends for every function that is bounded below.
    """

    # decrease, curvature: c₁ < c₂ of the two conditions
    decrease: float = number(1e-4, most=1)
    curvature: float = number(0.9, most=1)
    first: FirstTrial = field(default_factory=FirstTrial)
    # on the way to target lengths, where these are prescribed
    underway: Armijo = field(default_factory=Armijo)
    max_trials: int = number(40)

    def __post_init__(self) -> None:
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
        return float(np.sum(trial.derivative * trial.transport(direction))) >= self.curvature * slope


@dataclass(frozen=True, eq=False)
class Momentum:
    """The point before, and Nesterov's sequence t_k."""

    vertices: FloatArray
    t: float


@dataclass(frozen=True)
class Accelerated:
    """Nesterov's accelerated gradient: y = x + β (x − x_last), then x_next = y − τ u(y).

    Both sub-steps are truncated by collision detection, and the momentum is reset when the objective goes up
    (O'Donoghue and Candès, Adaptive restart for accelerated gradient schemes, 2015).
    """

    search: WeakWolfe = field(default_factory=WeakWolfe)  # finds τ
    second_order: ClassVar[bool] = False
    other_metrics: ClassVar[tuple[Metric, ...]] = ()

    def step(self, point: Point, state: State) -> tuple[Step | NoStep, State]:
        """Extrapolate, then take a gradient step from there; the path has both legs."""
        memory = Momentum(point.vertices, 1.0) if state.memory is None else state.memory
        t = 0.5 * (1.0 + math.sqrt(1.0 + 4.0 * memory.t**2))
        first = self._extrapolated(point, (memory.t - 1.0) / t * (point.vertices - memory.vertices))
        start = first.end if isinstance(first, Leg) else point
        step = self.search.along(start, -start.gradient, np.inf, state.last_step)
        if isinstance(step, NoStep):
            return (step, state) if state.memory is None else self.step(point, replace(state, memory=None))
        if isinstance(first, Leg):
            step = replace(step, legs=(first, *step.legs))
        rising = step.point.energy > point.energy
        return step, State(None if rising else Momentum(point.vertices, t), step.size)

    def _extrapolated(self, point: Point, momentum: FloatArray) -> Leg | Rejected:
        truncated, _ = self.search.first(point, momentum, 1.0)
        if truncated == 0.0:
            return Rejected()
        return attempt(point, point.vertices + truncated * momentum, point.residual, lambda q: True)
