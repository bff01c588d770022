"""Nesterov's accelerated gradient on the penalised energy (Section 6.4 of [RS21]).

Both sub-steps are truncated by collision detection, and the momentum is reset when the objective goes up
(O'Donoghue and Candès, Adaptive restart for accelerated gradient schemes, 2015).
"""

import math
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from ..metrics import Metric
from ..types import FloatArray
from .method import GROWTH, State, check_penalty
from .problem import Point
from .search import free_step
from .step import NoStep, Step, leg
from .wolfe import wolfe_step


@dataclass(frozen=True, eq=False)
class Memory:
    """The point before, and Nesterov's sequence t_k."""

    vertices: FloatArray
    t: float


@dataclass(frozen=True)
class AcceleratedGradient:
    """y = x + β (x − x_last), then x_next = y − τ u(y)."""

    name: str
    description: str
    metric: Metric
    penalty: float
    second_order: ClassVar[bool] = False

    def __post_init__(self) -> None:
        check_penalty(self.penalty)

    def step(self, point: Point, state: State) -> tuple[Step | NoStep, State]:
        """Extrapolate, then take a gradient step from there; the path has both legs."""
        memory = Memory(point.vertices, 1.0) if state.memory is None else state.memory
        t = 0.5 * (1.0 + math.sqrt(1.0 + 4.0 * memory.t**2))
        momentum = (memory.t - 1.0) / t * (point.vertices - memory.vertices)
        truncated, _ = free_step(point, momentum, 1.0)
        first = leg(point, point.problem.at(point.vertices + truncated * momentum))
        extrapolated = first.end if truncated > 0.0 and first.open else point
        longest = GROWTH * state.last_step
        natural = 1.0 if np.isinf(longest) else longest
        step = wolfe_step(extrapolated, -extrapolated.gradient, natural, np.inf)
        if isinstance(step, NoStep):
            return (step, state) if state.memory is None else self.step(point, replace(state, memory=None))
        if extrapolated is not point:
            step = replace(step, legs=(first, *step.legs))
        rising = step.point.energy > point.energy
        return step, State(None if rising else Memory(point.vertices, t), step.size)
