"""L-BFGS on the constraint manifold, with the point's metric as initial inverse Hessian.

The two-loop recursion of Nocedal and Wright (Numerical Optimization, Section 7.2) in covectors: gradients of the
Lagrangian in, directions out, and in the middle the saddle-point solve (41) of [RS21] where the textbook has a
multiple of the identity.  The result is projected onto the tangent space.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...types import FloatArray
from ..problem import Point


@dataclass(frozen=True, eq=False)
class Pairs:
    """The last point and the pairs (s, y) of displacements and Lagrangian-gradient differences, oldest first."""

    point: Point
    pairs: tuple[tuple[FloatArray, FloatArray], ...]


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

    def propose(self, point: Point, memory: Pairs | None) -> tuple[FloatArray, Pairs]:
        """The quasi-Newton direction, or steepest descent where that is no direction of descent."""
        pairs = () if memory is None else self._updated(memory, point)
        direction = -point.gradient
        if pairs or self.inverse is not None:
            direction = -self._two_loops(point, point.lagrangian_derivative(point.multipliers), pairs)
        slope = float(np.sum(point.derivative * direction))
        if not slope < -1e-3 * point.gradient_norm * point.tangent_space.norm(direction):
            direction, pairs = -point.gradient, ()
        return direction, Pairs(point, pairs)

    def _updated(self, memory: Pairs, point: Point) -> tuple[tuple[FloatArray, FloatArray], ...]:
        """The pairs with the one of the last step; it is left out if it carries no positive curvature."""
        last = memory.point
        s = point.vertices - last.vertices
        y = point.lagrangian_derivative(point.multipliers) - last.lagrangian_derivative(point.multipliers)
        if not np.sum(s * y) > 1e-8 * np.sum(s * point.tangent_space.apply(s)):
            return memory.pairs
        return (*memory.pairs, (s, y))[-self.history :]

    def _two_loops(self, point: Point, q: FloatArray, pairs: tuple[tuple[FloatArray, FloatArray], ...]) -> FloatArray:
        """H q for the inverse Hessian H that the pairs make of the first one."""
        weights = []
        for s, y in reversed(pairs):
            rho = 1.0 / np.sum(s * y)
            alpha = rho * np.sum(s * q)
            q = q - alpha * y
            weights.append((alpha, rho))
        r = point.tangent_space.gradient(q)[0] if self.inverse is None else self.inverse(q)
        for (s, y), (alpha, rho) in zip(pairs, reversed(weights), strict=True):
            r += (alpha - rho * np.sum(y * r)) * s
        return point.transport(r)
