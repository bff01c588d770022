"""A rope that is in the way of its own curve lets go and gives way, as far as that leads on."""

from dataclasses import dataclass, field

import numpy as np

from ...descent import NoStep, Step
from ...energies.components import energy_scale
from ...energies.rope import Rope
from ..move import Change, Move
from ..outcome import Outcome
from ..run import gradient_bound


@dataclass(eq=False)
class GiveWay(Move):
    """Let go of a rope that keeps its thickness where it holds the curve up: only the proof keeps it one from there on.

    It holds it up where it takes much of the flow, in step after step, and a thinner one promises enough: r ∂E/∂r.
    After that the radius gives way to what steps need.
    """

    held: float = 0.6  # part of the gradient without the rope, in the metric's norm, that is left
    patience: int = 15  # steps: saddles of flow and rope are left in a dozen
    rest: float = 1e-3  # the gradient's norm, relative to √E, from which on there is nothing to be patient for
    worth: float = 1e-3  # part of the energy that the promise must be
    share: float = 0.7  # that is left of the radius each time
    _steps: int = field(default=0, init=False)  # for which it has held the curve up

    def __post_init__(self) -> None:
        begins, keeps = self.run.iterate.index == 0, self.run.options.radius == "keep"
        radius = self.run.problem.radius
        self._sharp = begins and keeps and self.run.problem.certifiable and radius is None
        self._start = 0.0 if radius is None else float(radius.max())

    def started(self) -> Change | None:
        """Nothing is in the way of a curve that is at rest by itself."""
        self._steps = 0
        change = self._let_go()
        if change is None or change.point is None:
            return None
        own = change.point
        return change if own.gradient_norm <= gradient_bound(self.run.options, own.problem.mesh, own.energy) else None

    def stepped(self, step: Step) -> Change | None:
        point, rope = self.run.point, self.run.problem.objective.rope
        if rope is None or not self._may:
            return self._thinner() if step.limited_by is not None and self._may else None
        pressure, derivative = rope.value_and_derivative(point.curve)
        scale = energy_scale(point.problem.mesh, point.energy - pressure)
        # Euler's theorem, as E stays the same if rope and curve are scaled; lengths that weigh its terms count little
        if -np.sum(derivative * point.vertices) > self.worth * scale:
            own = point.derivative - derivative
            free = np.sqrt(max(0.0, np.sum(point.tangent_space.gradient(own)[0] * own)))
            if point.gradient_norm <= self.held * free:
                self._steps += 1
                patient = self._steps < self.patience and point.gradient_norm > self.rest * np.sqrt(scale)
                return None if patient else self._let_go()
        self._steps = 0
        return None

    def converged(self, outcome: Outcome) -> Change | None:
        """Let go: the barrier is over, and the proof stays, so that the curve is at rest by itself."""
        return self._let_go()

    def stuck(self, found: NoStep) -> Change | None:
        rope = self.run.problem.objective.rope
        if rope is not None and rope.value(self.run.point.curve):
            return self._let_go()
        return self._thinner() if rope is None and found.limited_by and self._may else None

    def summarised(self, outcome: Outcome) -> Outcome:
        now = self.run.problem.radius
        if self._sharp:
            return outcome.adding(
                "the curve is no rope, as a corner is too sharp, or an obstacle too near, at the start"
            )
        end = 0.0 if now is None else float(now.max())
        if end >= self._start:
            return outcome
        told = "the rope gave way from radius {start:.3g} to {end:.3g}, as it was in its own way"
        return outcome.adding(told, start=self._start, end=end)

    @property
    def _may(self) -> bool:
        """Whether there is a rope that may give way: what a hand does is no reason."""
        problem = self.run.problem
        return self.run.options.radius == "keep" and problem.radius is not None and problem.objective.pull is None

    def _let_go(self) -> Change | None:
        """The point without the barrier of a rope that may give way: it is still proved to be a rope."""
        point = self.run.point
        if not self._may or point.problem.objective.rope is None:
            return None
        return Change(point=point.changing(objective=point.problem.objective.having(Rope, None)))

    def _thinner(self) -> Change:
        radius = self.run.problem.radius
        assert radius is not None
        return Change(point=self.run.point.changing(radius=self.share * radius))
