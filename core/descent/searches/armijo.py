"""Line searches: Armijo's rule along the constraints (Section 6.3 of [RS21])."""

import math
from dataclasses import dataclass, field
from functools import partial
from typing import ClassVar, Protocol

import numpy as np

from ...checks import check_fields
from ...metrics import Metric
from ...types import FloatArray
from ..directions import Direction
from ..problem import Point
from ..step import Leg, NoStep, Rejected, State, Step, attempt
from .trials import NOTHING, FirstTrial, TowardsTargets, on_target

ROUNDING = 1e-14  # relative differences of energies that count as none
LEAST = 1e-3  # displacement, in the program's units, that is tried again on the way to the targets


class AlongLine(Protocol):
    """A search for the step size."""

    def along(self, point: Point, direction: FloatArray, natural: float, last: float) -> Step | NoStep:
        """Find a step along a descent direction, with its own and the last accepted step size; see `Armijo.along`."""


@dataclass(frozen=True)
class LineSearch:
    """Direction × search.

    Parameters
    ----------
    metric_steps
        Number of steps that a metric is made for, unless contact limits one of them: building and inverting it is most
        of the work, and a few steps on it is a metric all the same.
    """

    direction: Direction
    search: AlongLine
    metric_steps: int = 1
    second_order: ClassVar[bool] = False
    other_metrics: ClassVar[tuple[Metric, ...]] = ()

    def __post_init__(self) -> None:
        check_fields(self, metric_steps=(0, math.inf))

    def step(self, point: Point, state: State) -> tuple[Step | NoStep, State]:
        """Take one step; what fails is tried again without the direction's memory and in the metric of this curve."""
        direction, memory = self.direction.propose(point, state.memory)
        step = self.search.along(point, direction, self.direction.natural_step, state.last_step)
        if isinstance(step, NoStep):
            if state.memory is None and point.metric_age == 0:
                return step, state
            return self.step(point.with_own_metric(), State())
        if step.limited_by is None and point.metric_age + 1 < self.metric_steps:
            step = step.with_metric_of(point)
        return step, State(memory, step.size)


@dataclass(frozen=True)
class Armijo:
    """Shrink the first trial until the energy goes down enough and the motion is proved.

    Parameters
    ----------
    decrease
        Required fraction of the predicted decrease: the paper's ½.
    first
        The first trial.
    lengths
        How fast lengths go to their targets.
    max_trials
        Number of trials.
    """

    decrease: float = 0.5
    first: FirstTrial = field(default_factory=FirstTrial)
    lengths: TowardsTargets = field(default_factory=TowardsTargets)
    max_trials: int = 40

    def __post_init__(self) -> None:
        check_fields(self, decrease=(0.0, 1.0), max_trials=(0, math.inf))

    def along(self, point: Point, direction: FloatArray, natural: float, last: float) -> Step | NoStep:
        """Find a step along a descent direction.

        The motion is the straight one from P to Q, where Q = P + τ·direction, moved towards the target lengths if they
        are not reached yet, and back onto that level of the constraints by (42).  It is accepted if
        E(Q) ≤ E(P) + ½ DE·(Q₀ − P) and the motion from P to Q is proved free of contact.

        Parameters
        ----------
        direction
            Tangent vector with DE·direction < 0; shape (n, m).
        natural
            The direction's own step size.
        last
            The last accepted one.
        """
        tau, limited_by = self.first(point, direction, min(natural, self._longest(point, direction, last)))
        normal = self.lengths.at(point, point.tangent_space)
        slope_along = float(np.sum(point.derivative * direction))
        shrink = 1.0
        for _ in range(self.max_trials):
            share = normal.share(-shrink * tau * slope_along) * min(1.0, 4.0 * shrink)
            move = shrink * tau * direction + share * normal.full
            slope = shrink * tau * slope_along + share * normal.cost
            if not np.max(np.abs(move)) > NOTHING:
                break
            level = (1.0 - share) * point.residual
            slack = normal.slack(share, -shrink * tau * slope_along)
            trial = attempt(point, point.vertices + move, level, partial(self.sufficient, point, slope, slack))
            if isinstance(trial, Leg):
                return Step((trial,), shrink * tau, limited_by)
            limited_by = trial.in_the_way or limited_by
            shrink *= self._shorter(point, trial, slope)
        return NoStep.because(limited_by)

    def sufficient(self, point: Point, slope: float, slack: float, trial: Point) -> bool:
        """Armijo's rule; where the lengths' cost makes the slope positive, the energy may rise by twice the prediction.

        Where there is nothing left to gain, the way to the lengths may cost ``slack`` in addition.  Differences below
        the rounding of the energy count as none.
        """
        wanted = self.decrease * slope if slope < 0.0 else 2.0 * slope
        return trial.energy - point.energy <= wanted + slack + ROUNDING * abs(point.energy)

    def _longest(self, point: Point, direction: FloatArray, last: float) -> float:
        """A multiple of the last step, unless the lengths' part of that one may be what made it short.

        Step sizes that shrink again and again would leave the lengths' part alone, which costs energy and sees no
        strands.
        """
        longest = self.first.growth * last
        speed = float(np.max(np.abs(direction)))
        crawls = speed > 0.0 and longest * speed < LEAST
        return LEAST / speed if crawls and not on_target(point) else longest

    def _shorter(self, point: Point, rejected: Rejected, slope: float) -> float:
        """Factor for the next trial."""
        if rejected.proof is not None:
            return max(0.1, self.first.collision_fraction * rejected.proof.time)
        if rejected.trial is None or not slope < 0.0:
            return 0.5
        # the minimum of the parabola through what is known, within bounds
        excess = rejected.trial.energy - point.energy
        return min(0.6, max(0.1, -0.5 * slope / (excess - slope)))
