"""The motions that hops begin with, in the order of their turns."""

from collections.abc import Iterator
from typing import Protocol

import numpy as np

from ...descent import Point, Step
from .push import Push
from .stir import Stir


class Motion(Protocol):
    """A random way out of a minimum, or from where a curve is stuck."""

    def fits(self, point: Point) -> bool:
        """Whether the problem at hand is one for it."""

    def __call__(self, point: Point, rng: np.random.Generator) -> Iterator[Step]:
        """Yield proved steps, each of which ends on the constraints."""


MOTIONS: tuple[Motion, ...] = (Push(), Stir())
