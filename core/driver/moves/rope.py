"""A rope that is in the way of its own curve gives way, as far as that leads on."""

from dataclasses import dataclass, field

import numpy as np

from ...descent import NoStep, Point, Step
from ...energies.components import energy_scale
from ...energies.rope import Rope
from ..move import Change, Move
from ..outcome import Outcome
from ..run import gradient_bound


@dataclass(eq=False)
class GiveWay(Move):
    """Make a rope that keeps its thickness thinner where it holds the curve up, or leaves it no step.

    It holds it up where the last steps have gained little of what a thinner rope promises, r ∂E/∂r.  The first time
    there is more patience, as saddles of flow and rope are left in a dozen steps.
    """

    # that is left of the radius each time: with .8 it takes a fifth more iterations to where it ends
    share: float = 0.5
    first: tuple[int, float] = (15, 0.08)  # steps that must gain this part of the promise, the first time
    later: tuple[int, float] = (5, 0.5)
    every: int = 3  # steps, to save time
    worth: float = 1e-3  # part of the energy that the promise must be
    _start: float = field(default=0.0, init=False)  # radius before it gave way, if it did
    _energies: list[float] = field(default_factory=list, init=False)  # on this mesh

    def __post_init__(self) -> None:
        begins, keeps = self.run.iterate.index == 0, self.run.options.radius == "keep"
        self._sharp = begins and keeps and self.run.problem.certifiable and self.run.problem.radius is None

    def started(self) -> Change | None:
        """Nothing is in the way of a curve that is at rest by itself."""
        self._energies.clear()
        own = self._released
        at_rest = gradient_bound(self.run.options, own.problem.mesh, own.energy)
        return Change(point=own) if own is not self.run.point and own.gradient_norm <= at_rest else None

    def stepped(self, step: Step) -> Change | None:
        if self._may and step.limited_by is not None and self.run.problem.objective.rope is None:
            return self._thinner()
        self._energies.append(self.run.point.energy)
        steps, part = self.later if self._start else self.first
        if len(self._energies) <= steps or len(self._energies) % self.every:
            return None
        return self._where_in_the_way((self._energies[-1 - steps] - self._energies[-1]) / part)

    def converged(self, outcome: Outcome) -> Change | None:
        """Give way, or let go: the barrier is over, and the proof stays, so that the curve is at rest by itself."""
        own = self._released
        return self._where_in_the_way(0.0) or (Change(point=own) if own is not self.run.point else None)

    def _where_in_the_way(self, least: float) -> Change | None:
        """A thinner rope, if it promises more than that, and enough."""
        point, rope = self.run.point, self.run.problem.objective.rope
        if rope is None or not self._may:
            return None
        pressure, derivative = rope.value_and_derivative(point.curve)
        # Euler's theorem, as E stays the same if rope and curve are scaled; lengths that weigh its terms count little
        promise = -float(np.sum(derivative * point.vertices))
        worth = promise > self.worth * energy_scale(point.problem.mesh, point.energy - pressure)
        return self._thinner() if worth and promise > least else None

    def stuck(self, found: NoStep) -> Change | None:
        rope = self.run.problem.objective.rope  # which may have nothing to do with it, or be let go
        in_the_way = found.limited_by if rope is None else rope.value(self.run.point.curve)
        return self._thinner() if in_the_way and self._may else None

    def summarised(self, outcome: Outcome) -> Outcome:
        now = self.run.problem.radius
        if self._sharp:
            return outcome.adding(
                "the curve is no rope, as a corner is too sharp, or an obstacle too near, at the start"
            )
        if not self._start or now is None:
            return outcome
        told = "the rope gave way from radius {start:.3g} to {end:.3g}, as it was in its own way"
        return outcome.adding(told, start=self._start, end=float(now.max()))

    @property
    def _released(self) -> Point:
        """The point without the barrier of a rope that may give way: it is still proved to be a rope."""
        point = self.run.point
        kept = not self._may or point.problem.objective.rope is None
        return point if kept else point.changing(objective=point.problem.objective.having(Rope, None))

    @property
    def _may(self) -> bool:
        """Whether there is a rope that may give way: what a hand does is no reason."""
        problem = self.run.problem
        return self.run.options.radius == "keep" and problem.radius is not None and problem.objective.pull is None

    def _thinner(self) -> Change:
        point = self.run.point
        radius = point.problem.radius
        assert radius is not None
        self._start = self._start or float(radius.max())
        thinner = point.problem.as_rope(self.share * radius)
        return Change(point=point.changing(objective=thinner.objective, radius=thinner.radius))
