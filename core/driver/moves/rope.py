"""A rope that is in the way of its own curve gives way, as far as that leads on."""

import math
from dataclasses import dataclass, field

from ...base.arguments import number
from ...descent import NoStep, Step
from ...energies.components import energy_scale
from ...energies.rope import Rope
from ..outcome import Outcome
from ..run import Change, Move, gradient_bound


@dataclass(eq=False)
class GiveWay(Move):
    """Make a rope that keeps its thickness thinner where the curve rests against it, or finds no step for it."""

    share: float = number(0.7, most=1)  # that is left of the radius each time
    pressing: float = number(1e-4)  # part of the energy that the rope's barrier has where the curve rests against it
    gain: float = number(3e-4)  # part of the energy without which the next time is pointless
    most: int = number(12)  # times
    nearly: float = number(10.0)  # times the gradient of curves at rest, at which the rope's part of the energy shows
    _start: float = field(default=0.0, init=False)
    _times: int = field(default=0, init=False)
    _energy: float = field(default=math.inf, init=False)  # without the rope's, when it last gave way

    def stepped(self, step: Step) -> Change | None:
        point = self.run.point
        bound = gradient_bound(self.run.options, point.problem.mesh, point.energy)
        return self._where_pressed() if point.gradient_norm <= self.nearly * bound else None

    def converged(self, outcome: Outcome) -> Change | None:
        return self._where_pressed()

    def _where_pressed(self) -> Change | None:
        rope = self._rope
        if rope is None:
            return None
        point = self.run.point
        pressure = rope.value(point.curve)
        energy = energy_scale(point.problem.mesh, point.energy - pressure)
        if pressure <= self.pressing * energy or energy > (1.0 - self.gain) * self._energy:
            return None
        self._energy = energy
        return self._thinner()

    def stuck(self, found: NoStep) -> Change | None:
        rope = self._rope  # which may have nothing to do with it
        return None if rope is None or not rope.value(self.run.point.curve) else self._thinner()

    def summarised(self, outcome: Outcome) -> Outcome:
        now = self.run.problem.radius
        if now is None and self.run.options.radius == "keep":
            return outcome.adding(
                "the curve is no rope at the start: a corner is too sharp, or it has too many dimensions"
            )
        if not self._times or now is None:
            return outcome
        told = "the rope gave way from radius {start:.3g} to {end:.3g}, as it was in its own way"
        return outcome.adding(told, start=self._start, end=float(now.max()))

    @property
    def _rope(self) -> Rope | None:
        """The barrier of a rope that may give way."""
        keeps = self.run.options.radius == "keep" and self._times < self.most
        terms = self.run.problem.objective.terms if keeps else ()
        return next((term for term in terms if isinstance(term, Rope)), None)

    def _thinner(self) -> Change:
        point = self.run.point
        radius = point.problem.radius
        assert radius is not None
        self._start, self._times = self._start or float(radius.max()), self._times + 1
        thinner = point.problem.as_rope(self.share * radius)
        return Change(point=point.changing(objective=thinner.objective, radius=thinner.radius))
