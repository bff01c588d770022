"""A rule for directions and a search along them."""

from dataclasses import dataclass
from typing import ClassVar, Protocol

from ...metrics import Metric
from ...types import FloatArray
from ..directions import Direction
from ..problem import Point
from ..state import State
from ..step import NoStep, Step


class AlongLine(Protocol):
    """A search for the step size."""

    def along(self, point: Point, direction: FloatArray, natural: float, last: float) -> Step | NoStep:
        """Find a step along a descent direction, with its own and the last accepted step size; see `Armijo.along`."""


@dataclass(frozen=True)
class LineSearch:
    """Direction × search."""

    direction: Direction
    search: AlongLine
    second_order: ClassVar[bool] = False
    other_metrics: ClassVar[tuple[Metric, ...]] = ()

    def step(self, point: Point, state: State) -> tuple[Step | NoStep, State]:
        """Take one step; a remembering direction that fails is tried again without its memory."""
        direction, memory = self.direction.propose(point, state.memory)
        step = self.search.along(point, direction, self.direction.natural_step, state.last_step)
        if isinstance(step, NoStep) and state.memory is not None:
            return self.step(point, State())
        return step, (State(memory, step.size) if isinstance(step, Step) else state)
