"""The feasible step: collision-limited first trial, feasibility, Armijo's rule, proof that no contact happens."""

import math
from dataclasses import dataclass

import numpy as np

from ..types import FloatArray
from .feasibility import restore
from .problem import Point

COLLISION_FRACTION = 2.0 / 3.0  # of the first step with a contact, the first trial of [RS21], Section 6.3
MAX_DISPLACEMENT = 0.5  # of any vertex in one step, in the program's units (a component is 4 to 8 long)
MAX_TRIALS = 40
LENGTH_CHANGE = 0.25  # largest logarithmic change of an edge length in one step, on the way to the targets
FEASIBLE = 1e-7  # residual below which the curve counts as being on the constraints


@dataclass(frozen=True, eq=False)
class Step:
    """An accepted step.

    Attributes
    ----------
    point
        Where it ends.
    size
        Its τ.
    path
        Vertices at the ends of the straight legs that lead there, the last those of ``point``; all proved.
    limited_by
        The pair of edges whose contact limited τ, if any.
    """

    point: Point
    size: float
    path: tuple[FloatArray, ...]
    limited_by: tuple[int, int] | None


@dataclass(frozen=True)
class NoStep:
    """Why no step was found."""

    reason: str

    @classmethod
    def because(cls, limited_by: tuple[int, int] | None) -> "NoStep":
        """The usual two reasons: contact, or an energy that does not go down any more."""
        if limited_by is None:
            return cls("no step along the direction lowers the energy by a measurable amount")
        i, j = limited_by
        return cls(f"edges {i + 1} and {j + 1} are so near to each other that no step is free of contact")


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
    towards_targets, share = _normal_step(point, tau * direction)
    shrink = 1.0
    for _ in range(MAX_TRIALS):
        move = shrink * (tau * direction + towards_targets)
        slope = float(np.sum(point.derivative * move))
        if not np.max(np.abs(move)) > 1e-15:
            break
        trial = restore(point, point.vertices + move, (1.0 - shrink * share) * point.residual)
        if trial is None:
            shrink *= 0.5
            continue
        excess = trial.energy - point.energy
        if not _sufficient(excess, slope, point.energy):
            shrink *= _interpolated(excess, slope)
            continue
        proof = point.problem.free_motion(point.vertices, trial.vertices)
        if proof.time < 1.0:
            limited_by = proof.pair
            shrink *= max(0.1, COLLISION_FRACTION * proof.time)
            continue
        return Step(trial, shrink * tau, (trial.vertices,), limited_by)
    return NoStep.because(limited_by)


def free_step(point: Point, direction: FloatArray, longest: float) -> tuple[float, tuple[int, int] | None]:
    """The longest step worth trying: bounded displacement, and 2/3 of the first step with a contact.

    Returns it with the pair of edges that limits it, if any; the motion up to it is proved free of contact.
    """
    speed = float(np.max(np.linalg.norm(direction, axis=1)))
    if speed == 0.0:
        return 0.0, None
    tau = min(longest, MAX_DISPLACEMENT / speed)
    free = point.problem.free_motion(point.vertices, point.vertices + tau * direction)
    if free.time < 1.0:
        tau *= COLLISION_FRACTION * free.time
    return tau, free.pair


def _normal_step(point: Point, tangential: FloatArray) -> tuple[FloatArray, float]:
    """Displacement towards the targets of the constraints, and the share of the residual that it removes.

    Lengths change by a bounded factor, and the energy this costs is at most half of what the tangential step gains,
    so that the objective goes down; at a critical point of the objective the lengths go first.
    """
    worst = float(np.max(np.abs(point.residual)))
    if worst <= FEASIBLE:
        return np.zeros_like(tangential), 1.0
    share = min(1.0, LENGTH_CHANGE / worst)
    full = point.saddle.pseudo_inverse(-point.residual)
    cost = share * float(np.sum(point.derivative * full))
    gain = -float(np.sum(point.derivative * tangential))
    if cost > 0.5 * gain:
        share *= max(0.5 * gain / cost, 0.01)
    return share * full, share


def _sufficient(excess: float, slope: float, energy: float) -> bool:
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
