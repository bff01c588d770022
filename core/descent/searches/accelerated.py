"""Nesterov's accelerated gradient (Section 6.4 of [RS21]).

Both sub-steps are truncated by collision detection, and the momentum is reset when the objective goes up
(O'Donoghue and Candès, Adaptive restart for accelerated gradient schemes, 2015).
"""

import math
from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np

from ...metrics import Metric
from ...types import FloatArray
from ..problem import Point
from ..state import State
from ..step import Leg, NoStep, Rejected, Step, attempt
from .wolfe import WeakWolfe


@dataclass(frozen=True, eq=False)
class Momentum:
    """The point before, and Nesterov's sequence t_k."""

    vertices: FloatArray
    t: float


@dataclass(frozen=True)
class Accelerated:
    """y = x + β (x − x_last), then x_next = y − τ u(y).

    Parameters
    ----------
    search
        Finds τ.
    """

    search: WeakWolfe = field(default_factory=WeakWolfe)
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
