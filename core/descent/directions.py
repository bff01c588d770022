"""Rules for descent directions: steepest descent, conjugate gradients, and L-BFGS on the constraint manifold."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from ..base import FloatArray
from .problem import Point


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
        return -point.gradient, None


@dataclass(frozen=True)
class ConjugateGradient:
    """−u + β d with β = max(0, ⟨u, u − u_last⟩/⟨u_last, u_last⟩): Polak–Ribière with automatic reset (PR+).

    Nocedal and Wright, Numerical Optimization, Section 5.2, with the metric for every inner product and the geometry's
    transport.
    """

    natural_step: float = np.inf

    def propose(self, point: Point, memory: Any) -> tuple[FloatArray, Any]:
        """The conjugate direction, or steepest descent where that is no direction of descent.

        The memory is the last gradient, its squared norm, and the last direction.
        """
        direction = -point.gradient
        if memory is not None:
            last, square, before = memory
            # ⟨u, v⟩ = DE·v for tangent v, so the metric is needed for the transport only
            overlap = float(np.sum(point.derivative * point.transport(last)))
            beta = max(0.0, (point.gradient_norm**2 - overlap) / square)
            conjugate = direction + beta * point.transport(before)
            if np.sum(point.derivative * conjugate) < -1e-3 * point.gradient_norm * point.tangent_space.norm(conjugate):
                direction = conjugate
        return direction, (point.gradient, point.gradient_norm**2, direction)


@dataclass(frozen=True)
class LimitedMemoryBFGS:
    """Quasi-Newton direction from the last ``history`` steps.

    On tangles, where the curvature changes from step to step, few pairs are better than the paper's 30: Freedman's
    unknot takes 123 steps with 8 and 173 with 30.  At the end of the road it makes little difference.
    """

    history: int = 8
    # what stands for the inverse Hessian at first, from covectors, shape (n, m); by default the inverse of the metric
    inverse: Callable[[FloatArray], FloatArray] | None = None
    natural_step: float = 1.0

    def propose(self, point: Point, memory: Any) -> tuple[FloatArray, Any]:
        """The quasi-Newton direction, or steepest descent where that is no direction of descent.

        The memory is the last point and the pairs (s, y) of displacements and Lagrangian-gradient differences, oldest
        first.
        """
        last, pairs = (None, ()) if memory is None else memory
        q = point.lagrangian_derivative(point.multipliers)
        if last is not None:  # a step without positive curvature leaves no pair
            s, y = point.vertices - last.vertices, q - last.lagrangian_derivative(point.multipliers)
            if np.sum(s * y) > 1e-8 * np.sum(s * point.tangent_space.apply(s)):
                pairs = (*pairs, (s, y))[-self.history :]
        direction = -point.gradient
        if pairs or self.inverse is not None:
            # H q for the inverse Hessian H that the pairs make of the first one, by two loops
            weights = []
            for s, y in reversed(pairs):
                rho = 1.0 / np.sum(s * y)
                alpha = rho * np.sum(s * q)
                q = q - alpha * y
                weights.append((alpha, rho))
            r = point.tangent_space.gradient(q)[0] if self.inverse is None else self.inverse(q)
            for (s, y), (alpha, rho) in zip(pairs, reversed(weights), strict=True):
                r += (alpha - rho * np.sum(y * r)) * s
            direction = -point.transport(r)
        slope = float(np.sum(point.derivative * direction))
        if not slope < -1e-3 * point.gradient_norm * point.tangent_space.norm(direction):
            direction, pairs = -point.gradient, ()
        return direction, (point, pairs)
