"""A rule for directions and a search along them."""

import math
from dataclasses import dataclass
from typing import ClassVar, Protocol

from ...checks import check_fields
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
