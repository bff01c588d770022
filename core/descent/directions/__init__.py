"""Rules for descent directions."""

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from ...types import FloatArray
from ..problem import Point
from .lbfgs import LimitedMemoryBFGS

__all__ = ["ConjugateGradient", "Direction", "LimitedMemoryBFGS", "SteepestDescent"]


class Direction(Protocol):
    """A rule for descent directions; what it remembers from step to step is a value passed in and out."""

    @property
    def natural_step(self) -> float:
        """The step size to try first; inf if the direction has no scale of its own."""

    def propose(self, point: Point, memory: Any) -> tuple[FloatArray, Any]:
        """Tangent direction at the point, shape (n, m), and the memory for the next call; None is no memory."""


@dataclass(frozen=True)
class SteepestDescent:
    """−u, u the projected gradient of (41): the flow of Section 6.2 of [RS21], explicit in time."""

    natural_step: float = np.inf

    def propose(self, point: Point, memory: None) -> tuple[FloatArray, None]:
        """The negative projected gradient; nothing is remembered."""
        return -point.gradient, None


@dataclass(frozen=True, eq=False)
class LastDirection:
    """The last gradient, its squared norm, and the last direction."""

    gradient: FloatArray
    square: float
    direction: FloatArray


@dataclass(frozen=True)
class ConjugateGradient:
    """−u + β d with β = max(0, ⟨u, u − u_last⟩/⟨u_last, u_last⟩): Polak–Ribière with automatic reset (PR+).

    Nocedal and Wright, Numerical Optimization, Section 5.2, with the metric for every inner product and the geometry's
    transport.
    """

    natural_step: float = np.inf

    def propose(self, point: Point, memory: LastDirection | None) -> tuple[FloatArray, LastDirection]:
        """The conjugate direction, or steepest descent where that is no direction of descent."""
        direction = -point.gradient
        if memory is not None:
            # ⟨u, v⟩ = DE·v for tangent v, so the metric is needed for the transport only
            overlap = float(np.sum(point.derivative * point.transport(memory.gradient)))
            beta = max(0.0, (point.gradient_norm**2 - overlap) / memory.square)
            conjugate = direction + beta * point.transport(memory.direction)
            if np.sum(point.derivative * conjugate) < -1e-3 * point.gradient_norm * point.tangent_space.norm(conjugate):
                direction = conjugate
        return direction, LastDirection(point.gradient, point.gradient_norm**2, direction)
