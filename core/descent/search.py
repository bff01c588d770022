"""The feasible step: collision-limited first trial, feasibility, Armijo's rule, proof that no contact happens."""

import math
from dataclasses import dataclass

import numpy as np

from ..saddle import SaddleSolver
from ..types import FloatArray
from .feasibility import restore
from .problem import Point
from .step import NoStep, Step, leg

COLLISION_FRACTION = 2.0 / 3.0  # of the first step with a contact, the first trial of [RS21], Section 6.3
MAX_DISPLACEMENT = 0.5  # of any vertex in one step, in the program's units (a component is 4 to 8 long)
MAX_TRIALS = 40
LENGTH_CHANGE = 0.25  # largest logarithmic change of an edge length in one step, on the way to the targets
SMALL_SHARE = 0.01  # of the way to the target lengths, taken even where it costs more energy than can be gained
FEASIBLE = 1e-7  # residual below which the curve counts as being on the constraints


def armijo_step(point: Point, direction: FloatArray, longest: float) -> Step | NoStep:
    """Find a step along a descent direction.

    The motion is the straight one from P to Q, where Q = P + τ·direction, moved towards the target lengths if they
    are not reached yet, and back onto that level of the constraints by (42).  It is accepted if
    E(Q) ≤ E(P) + ½ DE·(Q₀ − P) (Armijo) and the motion from P to Q is proved free of contact.

    Parameters
    ----------
    direction
        Tangent vector with DE·direction < 0; shape (n, m).
    longest
        Upper bound of τ.
    """
    tau, limited_by = free_step(point, direction, longest)
    normal = NormalStep.at(point, point.saddle)
    slope_along = float(np.sum(point.derivative * direction))
    shrink = 1.0
    for _ in range(MAX_TRIALS):
        share = normal.share(-shrink * tau * slope_along) * min(1.0, 4.0 * shrink)
        move = shrink * tau * direction + share * normal.full
        slope = shrink * tau * slope_along + share * normal.cost
        if not np.max(np.abs(move)) > 1e-15:
            break
        trial = restore(point, point.vertices + move, (1.0 - share) * point.residual)
        if trial is None:
            shrink *= 0.5
            continue
        excess = trial.energy - point.energy
        if not sufficient(excess, slope, point.energy):
            shrink *= _interpolated(excess, slope)
            continue
        motion = leg(point, trial)
        if not motion.open:
            limited_by = motion.proof.pair
            shrink *= max(0.1, COLLISION_FRACTION * motion.proof.time)
            continue
        return Step((motion,), shrink * tau, limited_by)
    return NoStep.because(limited_by)


def free_step(point: Point, direction: FloatArray, longest: float) -> tuple[float, tuple[int, int] | None]:
    """The longest step worth trying: bounded displacement, and 2/3 of the first step with a contact.

    Returns it with the pair of edges that limits it, if any. Nothing is proved yet: a point on the way is rounded.
    """
    speed = float(np.max(np.linalg.norm(direction, axis=1)))
    if speed == 0.0:
        return 0.0, None
    tau = min(longest, MAX_DISPLACEMENT / speed)
    free = leg(point, point.problem.at(point.vertices + tau * direction)).proof
    if free.time < 1.0:
        tau *= COLLISION_FRACTION * free.time
    return tau, free.pair


@dataclass(frozen=True, eq=False)
class NormalStep:
    """The way to the targets of the constraints.

    Attributes
    ----------
    full
        −C^† Φ, the displacement that reaches them to first order; shape (n, m).
    cost
        DE·full, the energy that takes.
    longest
        The share of it that changes no length by more than a bounded factor.
    """

    full: FloatArray
    cost: float
    longest: float

    @classmethod
    def at(cls, point: Point, solver: SaddleSolver) -> "NormalStep":
        """The normal step at a point, none if it is on the constraints; ``solver`` gives the pseudo-inverse."""
        worst = float(np.max(np.abs(point.residual)))
        if worst <= FEASIBLE:
            return cls(np.zeros_like(point.vertices), 0.0, 1.0)
        full = solver.pseudo_inverse(-point.residual)
        return cls(full, float(np.sum(point.derivative * full)), min(1.0, LENGTH_CHANGE / worst))

    def share(self, gain: float) -> float:
        """The share to take along with a tangential step that gains so much energy.

        It costs at most half the gain, so that the objective goes down; but where there is nothing left to gain the
        lengths go on, slowly, all the same.
        """
        if self.longest * self.cost <= 0.5 * gain:
            return self.longest
        return max(0.5 * gain / self.cost, SMALL_SHARE * self.longest)


def sufficient(excess: float, slope: float, energy: float) -> bool:
    """Armijo's rule; where the lengths' cost makes the slope positive, the energy may rise by twice the prediction.

    Differences below the rounding of the energy count as none.
    """
    rounding = 1e-14 * abs(energy)
    return math.isfinite(excess) and excess <= (0.5 * slope if slope < 0.0 else 2.0 * slope) + rounding


def _interpolated(excess: float, slope: float) -> float:
    """Factor for the next trial: the minimum of the parabola through what is known, between 0.1 and 0.6."""
    if not (math.isfinite(excess) and slope < 0.0):
        return 0.5
    return min(0.6, max(0.1, -0.5 * slope / (excess - slope)))
