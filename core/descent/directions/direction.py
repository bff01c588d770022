"""What a rule for directions is."""

from typing import Any, Protocol

from ...types import FloatArray
from ..problem import Point


class Direction(Protocol):
    """A rule for descent directions; what it remembers from step to step is a value passed in and out."""

    @property
    def natural_step(self) -> float:
        """The step size to try first; inf if the direction has no scale of its own."""

    def propose(self, point: Point, memory: Any) -> tuple[FloatArray, Any]:
        """Tangent direction at the point, shape (n, m), and the memory for the next call; None is no memory."""
