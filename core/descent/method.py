"""A descent method: a direction, found in a metric, and a step search.  Adding one is a file and a registry line."""

from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np

from ..metrics import Metric
from ..types import FloatArray
from .problem import Point
from .search import GROWTH, NoStep, Step, armijo_step


class Direction(Protocol):
    """A rule for descent directions; what it remembers from step to step is a value passed in and out."""

    @property
    def natural_step(self) -> float:
        """The step size to try first; inf if the direction has no scale of its own."""

    def propose(self, point: Point, memory: Any) -> tuple[FloatArray, Any]:
        """Tangent direction at the point, shape (n, m), and the memory for the next call; None is no memory."""


@dataclass(frozen=True, eq=False)
class State:
    """Where a method stands: its direction's memory and the last accepted step size."""

    memory: Any = None
    last_step: float = np.inf


@dataclass(frozen=True)
class Method:
    """A feasible descent method.

    Attributes
    ----------
    name, description
        As shown to users.
    metric
        The inner product.
    direction
        The rule for descent directions.
    """

    name: str
    description: str
    metric: Metric
    direction: Direction

    def step(self, point: Point, state: State) -> tuple[Step | NoStep, State]:
        """Take one step; a remembering direction that fails is tried again without its memory."""
        direction, memory = self.direction.propose(point, state.memory)
        longest = min(self.direction.natural_step, GROWTH * state.last_step)
        step = armijo_step(point, direction, longest)
        if isinstance(step, NoStep) and state.memory is not None:
            return self.step(point, replace(state, memory=None))
        if isinstance(step, Step):
            state = State(memory, step.size)
        return step, state
