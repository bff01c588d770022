"""What searches try first: how far along a direction, and how much of the way to target lengths with it."""

from dataclasses import dataclass

import numpy as np

from ...checks import check_fields
from ...collision import Contact
from ...energies.components import energy_scale
from ...saddle import TangentSpace
from ...types import FloatArray
from ..problem import Point
from ..step import leg

NOTHING = 1e-15  # displacement, in the program's units, that changes no coordinate
FEASIBLE = 1e-7  # error below which a curve counts as being on the constraints


@dataclass(frozen=True)
class FirstTrial:
    """The first step size worth trying (Section 6.3 of [RS21]).

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


def on_target(point: Point) -> bool:
    """Whether a point is on the constraints, or on its way there no more."""
    return point.infeasibility <= FEASIBLE


@dataclass(frozen=True, eq=False)
class NormalStep:
    """The way to the targets of the constraints from one point.

    Attributes
    ----------
    full
        −C^† Φ, the displacement that reaches them to first order; shape (n, m).
    cost
        DE·full, the energy that takes.
    longest
        The share of it that changes no length by more than a bounded factor.
    least
        The share taken even where it costs more energy than can be gained.
    allowance
        The energy that all of it may cost where there is nothing left to gain: there the first order says nothing.
    """

    full: FloatArray
    cost: float
    longest: float
    least: float
    allowance: float

    def share(self, gain: float) -> float:
        """The share to take along with a tangential step that gains so much energy.

        It costs at most half the gain, so that the objective goes down; but where there is nothing left to gain the
        lengths go on, slowly, all the same.
        """
        affordable = 0.5 * max(gain, self.allowance)
        if self.longest * self.cost <= affordable:
            return self.longest
        return max(affordable / self.cost, self.least)

    def slack(self, share: float, gain: float) -> float:
        """By how much a step with such a share may miss its prediction."""
        return share * max(0.0, self.allowance - gain)


@dataclass(frozen=True)
class TowardsTargets:
    """How fast lengths go to their targets.

    Parameters
    ----------
    length_change
        Largest logarithmic change of an edge length in one step.
    least_share
        Of that step, taken even where it costs more energy than can be gained.
    allowance
        Part of the energy, by its scale, that reaching the targets may cost where there is nothing left to gain.
    """

    length_change: float = 0.25
    least_share: float = 0.01
    allowance: float = 1e-3

    def __post_init__(self) -> None:
        check_fields(self, length_change=(0.0, np.inf), least_share=(0.0, 1.0), allowance=(0.0, 1.0))

    def at(self, point: Point, space: TangentSpace) -> NormalStep:
        """The normal step at a point, none if it is on target; ``space`` gives the pseudo-inverse."""
        if on_target(point):
            return NormalStep(np.zeros_like(point.vertices), 0.0, 1.0, 1.0, 0.0)
        full = space.pseudo_inverse(-point.residual)
        longest = min(1.0, self.length_change / point.infeasibility)
        cost = float(np.sum(point.derivative * full))
        allowance = self.allowance * energy_scale(point.problem.mesh, point.energy)
        return NormalStep(full, cost, longest, self.least_share * longest, allowance)
