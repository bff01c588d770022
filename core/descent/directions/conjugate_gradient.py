"""Nonlinear conjugate gradients, Polak–Ribière with automatic reset (PR+).

Nocedal and Wright, Numerical Optimization, Section 5.2, with the metric for every inner product and the
geometry's transport.
"""

from dataclasses import dataclass

import numpy as np

from ...types import FloatArray
from ..problem import Point


@dataclass(frozen=True, eq=False)
class LastDirection:
    """The last gradient, its squared norm, and the last direction."""

    gradient: FloatArray
    square: float
    direction: FloatArray


@dataclass(frozen=True)
class ConjugateGradient:
    """−u + β d with β = max(0, ⟨u, u − u_last⟩/⟨u_last, u_last⟩)."""

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
