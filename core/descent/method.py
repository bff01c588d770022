"""A descent method: a direction, found in a metric, and a step search.  Adding one is a file and a registry line."""

from dataclasses import dataclass
from typing import Any, ClassVar, Protocol

import numpy as np

from ..errors import OptionError
from ..metrics import Metric
from ..types import FloatArray
from .problem import Point
from .search import armijo_step
from .step import NoStep, Step
from .wolfe import wolfe_step

GROWTH = 4.0  # a first trial is at most this many times the last accepted step
DEFAULT_PENALTY = 1000.0  # α of the infeasible methods


@dataclass(frozen=True, eq=False)
class State:
    """Where a method stands: its own memory (None at the start) and the last accepted step size."""

    memory: Any = None
    last_step: float = np.inf


class Method(Protocol):
    """A way to go from point to point."""

    @property
    def name(self) -> str:
        """Name in the registry."""

    @property
    def description(self) -> str:
        """One line for users."""

    @property
    def metric(self) -> Metric:
        """The inner product that gradients are taken in."""

    @property
    def penalty(self) -> float | None:
        """α if the method minimises the penalised energy, None if it keeps the constraints."""

    @property
    def second_order(self) -> bool:
        """Whether the method needs the energy's second derivative."""

    def step(self, point: Point, state: State) -> tuple[Step | NoStep, State]:
        """Take one certified step."""


class Direction(Protocol):
    """A rule for descent directions; what it remembers from step to step is a value passed in and out."""

    @property
    def natural_step(self) -> float:
        """The step size to try first; inf if the direction has no scale of its own."""

    def propose(self, point: Point, memory: Any) -> tuple[FloatArray, Any]:
        """Tangent direction at the point, shape (n, m), and the memory for the next call; None is no memory."""


@dataclass(frozen=True)
class LineSearchMethod:
    """A direction followed by a line search: Armijo on the constraints, Wolfe–Powell on the penalised energy."""

    name: str
    description: str
    metric: Metric
    direction: Direction
    penalty: float | None = None
    second_order: ClassVar[bool] = False

    def __post_init__(self) -> None:
        check_penalty(self.penalty)

    def step(self, point: Point, state: State) -> tuple[Step | NoStep, State]:
        """Take one step; a remembering direction that fails is tried again without its memory."""
        direction, memory = self.direction.propose(point, state.memory)
        longest = GROWTH * state.last_step
        if self.penalty is None:
            step = armijo_step(point, direction, min(self.direction.natural_step, longest))
        else:
            natural = min(self.direction.natural_step, 1.0 if np.isinf(longest) else longest)
            step = wolfe_step(point, direction, natural, np.inf)
        if isinstance(step, NoStep) and state.memory is not None:
            return self.step(point, State())
        if isinstance(step, Step):
            state = State(memory, step.size)
        return step, state


def check_penalty(penalty: float | None) -> None:
    """Raise an OptionError unless α is None or a finite positive number."""
    if penalty is not None and not (np.isfinite(penalty) and penalty > 0.0):
        raise OptionError(f"penalty is {penalty}; it must be a finite number above 0")
