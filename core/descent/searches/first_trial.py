"""The first step size worth trying (Section 6.3 of [RS21])."""

from dataclasses import dataclass

import numpy as np

from ...checks import check_fields
from ...collision import Contact
from ...types import FloatArray
from ..problem import Point
from ..step import leg

NOTHING = 1e-15  # displacement, in the program's units, that changes no coordinate


@dataclass(frozen=True)
class FirstTrial:
    """Bounds of the first trial.

    Parameters
    ----------
    collision_fraction
        Of the first step with a contact: the paper's 2/3.
    max_displacement
        Of any vertex, in the program's units, in which a component is 4 to 8 long.
    growth
        The first trial is at most this many times the last accepted step.
    """

    collision_fraction: float = 2.0 / 3.0
    max_displacement: float = 0.5
    growth: float = 4.0

    def __post_init__(self) -> None:
        check_fields(self, collision_fraction=(0.0, 1.0), max_displacement=(0.0, np.inf), growth=(1.0, np.inf))

    def __call__(self, point: Point, direction: FloatArray, longest: float) -> tuple[float, Contact | None]:
        """The first trial τ ≤ ``longest`` along a direction, and the contact that limits it, if any.

        Nothing is proved yet: the points on the way are rounded.
        """
        speed = float(np.max(np.linalg.norm(direction, axis=1)))
        if speed == 0.0:
            return 0.0, None
        tau = min(longest, self.max_displacement / speed)
        free = leg(point, point.problem.at(point.vertices + tau * direction)).proof
        if free.time < 1.0:
            tau *= self.collision_fraction * free.time
        return tau, free.contact
