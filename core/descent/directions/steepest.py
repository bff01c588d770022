"""Projected gradient flow, explicit in time (Section 6.2 of [RS21]): the direction of steepest descent in a metric."""

from dataclasses import dataclass

import numpy as np

from ...types import FloatArray
from ..problem import Point


@dataclass(frozen=True)
class SteepestDescent:
    """−u, u the projected gradient of (41)."""

    natural_step: float = np.inf

    def propose(self, point: Point, memory: None) -> tuple[FloatArray, None]:
        """The negative projected gradient; nothing is remembered."""
        return -point.gradient, None
