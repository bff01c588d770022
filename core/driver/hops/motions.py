"""The random motions that leave a minimum."""

from collections.abc import Iterator, Sequence
from typing import Protocol

import numpy as np

from ...descent import Point, Step
from .other_energy import OtherEnergy
from .soft_modes import SoftModes
from .stir import Stir


class Motion(Protocol):
    """A way out of a minimum."""

    def fits(self, point: Point) -> bool:
        """Whether it can be made from a point, and has time for so many vertices."""

    def __call__(self, point: Point, rng: np.random.Generator) -> Iterator[Step]:
        """Yield steps that lead away from a point, on its mesh; all that is random comes from ``rng``."""


MOTIONS: Sequence[Motion] = (SoftModes(), Stir(), OtherEnergy("edge"))
"""By turns in this order."""
