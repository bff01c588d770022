"""Line searches: what is tried first, Armijo's rule along the constraints, and Wolfe's (Section 6 of [RS21])."""

from dataclasses import dataclass, field
from functools import partial
from typing import ClassVar, NamedTuple, Protocol

import numpy as np

from ..base import ENERGY_ROUNDING, FloatArray
from ..collision import Contact
from ..energies.components import energy_scale
from ..solve.metrics import Metric
from ..solve.saddle import TangentSpace
from .directions import Direction
from .problem import Point
from .step import Leg, NoStep, SearchState, Step, attempt

NOTHING = 1e-15  # displacement, in the program's units, that changes no coordinate


@dataclass(frozen=True)
class FirstTrial:
    """The first step size worth trying (Section 6.3 of [RS21])."""

    collision_fraction: float = 2.0 / 3.0  # of the first step with a contact: the paper's 2/3
    max_displacement: float = 0.5  # of any vertex, in the program's units, in which a component is 4 to 8 long
    growth: float = 4.0  # the first trial is at most this many times the last accepted step

    def __call__(self, point: Point, direction: FloatArray, longest: float) -> tuple[float, Contact | None]:
        """The first trial τ ≤ ``longest`` along a direction, and the contact that limits it, if any.

        Nothing is proved yet: the points on the way are rounded.
        """
        speed = float(np.max(np.linalg.norm(direction, axis=1)))
        if speed == 0.0:
            return 0.0, None
        tau = min(longest, self.max_displacement / speed)
        if (rope := point.problem.objective.rope) is not None:  # its barrier shortens steps, here at little cost
            while rope.meets(point.curve.with_vertices(point.vertices + tau * direction)) and tau > 1e-9:
                tau *= 0.5
            return tau, None
        end = point.problem.at(point.vertices + tau * direction)
        free = point.problem.free_motion(point.placed, end.placed)
        if free.time < 1.0:
            tau *= self.collision_fraction * free.time
        return tau, free.contact


def on_target(point: Point) -> bool:
    """Whether a point is on the constraints, or on its way there no more."""
    return point.infeasibility <= 1e-7  # error below which a curve counts as being on the constraints


class NormalStep(NamedTuple):
    """The way to the targets of the constraints from one point."""

    full: FloatArray  # −C^† Φ, the displacement that reaches them to first order; shape (n, m)
    cost: float  # DE·full, the energy that takes
    longest: float  # the share of it that changes no length by more than a bounded factor
    least: float  # the share taken even where it costs more energy than can be gained
    # the energy that all of it may cost where there is nothing left to gain: there the first order says nothing
    allowance: float

    @classmethod
    def at(cls, point: Point, space: TangentSpace) -> "NormalStep":
        """The normal step at a point, none if it is on target; ``space`` gives the pseudo-inverse."""
        if on_target(point):
            return cls(np.zeros_like(point.vertices), 0.0, 1.0, 1.0, 0.0)
        full = space.pseudo_inverse(-point.residual)
        longest = min(1.0, 0.25 / point.infeasibility)  # so much is the logarithmic change of a length
        cost = float(np.sum(point.derivative * full))
        return cls(full, cost, longest, 0.01 * longest, 1e-3 * energy_scale(point.problem.mesh, point.energy))


class AlongLine(Protocol):
    """A search for the step size."""

    def along(self, point: Point, direction: FloatArray, natural: float, last: float) -> Step | NoStep:
        """Find a step along a descent direction, with its own and the last accepted step size; see `Armijo.along`."""


@dataclass(frozen=True)
class LineSearch:
    """Direction × search."""

    direction: Direction
    search: AlongLine
    # number of steps that a metric is made for, unless contact limits one of them: building and inverting it is most
    # of the work, and a few steps on it is a metric all the same
    metric_steps: int = 1
    second_order: ClassVar[bool] = False
    other_metrics: ClassVar[tuple[Metric, ...]] = ()

    def step(self, point: Point, state: SearchState) -> tuple[Step | NoStep, SearchState]:
        """Take one step; what fails is tried again without the direction's memory and in the metric of this curve."""
        direction, memory = self.direction.propose(point, state.memory)
        step = self.search.along(point, direction, self.direction.natural_step, state.last_step)
        if isinstance(step, NoStep):
            if state.memory is None and point.metric_age == 0:
                return step, state
            return self.step(point.with_own_metric(), SearchState())
        if step.limited_by is None and point.metric_age + 1 < self.metric_steps:
            step = step.with_metric_of(point)
        return step, SearchState(memory, step.size)


@dataclass(frozen=True)
class Armijo:
    """Shrink the first trial until the energy goes down enough and the motion is proved."""

    decrease: float = 0.5  # required fraction of the predicted decrease: the paper's ½
    first: FirstTrial = field(default_factory=FirstTrial)
    max_trials: int = 40

    def along(self, point: Point, direction: FloatArray, natural: float, last: float) -> Step | NoStep:
        """Find a step along a tangent direction with DE·direction < 0; shape (n, m).

        The motion is the straight one from P to Q, where Q = P + τ·direction, moved towards the target lengths if they
        are not reached yet, and back onto that level of the constraints by (42).  It is accepted if E(Q) ≤ E(P) + ½
        DE·(Q₀ − P) and the motion from P to Q is proved free of contact.  τ is at most the direction's own step size,
        ``natural``, and a multiple of the last accepted one.
        """
        longest, speed = self.first.growth * last, float(np.max(np.abs(direction)))
        if speed > 0.0 and longest * speed < 1e-3 and not on_target(point):
            # the lengths' part may be what made the last step short: it would be left alone, which costs energy and
            # sees no strands, by step sizes that shrink again and again
            longest = 1e-3 / speed
        tau, limited_by = self.first(point, direction, min(natural, longest))
        normal = NormalStep.at(point, point.tangent_space)
        slope_along = float(np.sum(point.derivative * direction))
        # lengths go on by less only where steps are shorter than they would be by the usual growth: without a bound on
        # it, as in the paper, first trials are far too long near rest, and lengths would never arrive
        shrink, usual = 1.0, max(FirstTrial.growth * last, 1e-3 / speed if speed > 0.0 else 0.0)
        lead = max(1.0, tau / usual) if usual > 0.0 else 1.0
        for _ in range(self.max_trials):
            # the share of the normal step to take along costs at most half of what the tangential one gains, so that
            # the objective goes down; but where there is nothing left to gain lengths go on, slowly, all the same
            gain = -shrink * tau * slope_along
            affordable, share = 0.5 * max(gain, normal.allowance), normal.longest
            if share * normal.cost > affordable:
                share = max(affordable / normal.cost, normal.least)
            share *= min(1.0, 4.0 * shrink * lead)
            move = shrink * tau * direction + share * normal.full
            slope = share * normal.cost - gain
            if not np.max(np.abs(move)) > NOTHING:
                break
            level = (1.0 - share) * point.residual
            slack = share * max(0.0, normal.allowance - gain)  # by how much the step may miss its prediction
            trial = attempt(point, point.vertices + move, level, partial(self.sufficient, point, slope, slack))
            if isinstance(trial, Leg):
                return Step((trial,), shrink * tau, limited_by)
            limited_by = trial.in_the_way or limited_by
            if trial.proof is not None:
                shrink *= max(0.1, self.first.collision_fraction * trial.proof.time)
            elif trial.trial is None or not slope < 0.0:
                shrink *= 0.5
            else:  # the minimum of the parabola through what is known, within bounds
                excess = trial.trial.energy - point.energy
                shrink *= min(0.6, max(0.1, -0.5 * slope / (excess - slope)))
        return NoStep.because(limited_by)

    def sufficient(self, point: Point, slope: float, slack: float, trial: Point) -> bool:
        """Armijo's rule; where the lengths' cost makes the slope positive, the energy may rise by twice the prediction.

        Where there is nothing left to gain, the way to the lengths may cost ``slack`` in addition.  Differences below
        the rounding of the energy count as none.
        """
        wanted = self.decrease * slope if slope < 0.0 else 2.0 * slope
        return trial.energy - point.energy <= wanted + slack + ENERGY_ROUNDING * abs(point.energy)
