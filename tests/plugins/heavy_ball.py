"""A direction: Polyak's heavy ball."""

from dataclasses import dataclass

import numpy as np

from ..base.types import FloatArray
from .problem import Point


@dataclass(frozen=True)
class HeavyBall:
    """−u + β Π d_last, or −u where that is no direction of descent."""

    momentum: float = 0.5
    natural_step: float = np.inf

    def propose(self, point: Point, memory: FloatArray | None) -> tuple[FloatArray, FloatArray]:
        """The direction, which is also what is remembered."""
        direction = -point.gradient
        if memory is not None:
            pushed = direction + self.momentum * point.transport(memory)
            if np.sum(point.derivative * pushed) < 0.5 * np.sum(point.derivative * direction):
                direction = pushed
        return direction, direction
