"""The infeasible methods' step: a weak Wolfe–Powell line search along a straight line proved free of contact.

Bisection after Lewis and Overton (Nonsmooth optimization via quasi-Newton methods, 2013): it needs no more than the
two conditions and ends for every function that is bounded below.
"""

import math

import numpy as np

from ..types import FloatArray
from .problem import Point
from .search import MAX_TRIALS, free_step
from .step import NoStep, Step, leg

SUFFICIENT_DECREASE = 1e-4
CURVATURE = 0.9


def wolfe_step(point: Point, direction: FloatArray, natural: float, longest: float) -> Step | NoStep:
    """Find a step with E(Q) ≤ E(P) + c₁ τ DE·d and DE(Q)·d ≥ c₂ DE·d, c₁ = 1e-4, c₂ = 0.9.

    If contact ends the line before the second condition holds, the longest step found is taken.

    Parameters
    ----------
    direction
        d with DE·d < 0; shape (n, m).
    natural
        First trial.
    longest
        Upper bound of τ.
    """
    end, limited_by = free_step(point, direction, longest)
    slope = float(np.sum(point.derivative * direction))
    low, high = 0.0, math.inf
    best: Step | None = None
    tau = min(natural, end)
    for _ in range(MAX_TRIALS):
        if not tau * np.max(np.abs(direction)) > 1e-15:
            break
        trial = point.problem.at(point.vertices + tau * direction)
        excess = trial.energy - point.energy if _nondegenerate(trial) else math.inf
        if not (math.isfinite(excess) and excess <= SUFFICIENT_DECREASE * tau * slope + 1e-14 * abs(point.energy)):
            high = tau
        elif not (motion := leg(point, trial)).open:
            high, limited_by = tau, motion.proof.pair
        else:
            best, low = Step((motion,), tau, limited_by), tau
            if np.sum(trial.derivative * direction) >= CURVATURE * slope or tau >= end:
                break
        tau = min(end, 2.0 * low) if math.isinf(high) else 0.5 * (low + high)
    return NoStep.because(limited_by) if best is None else best


def _nondegenerate(point: Point) -> bool:
    return bool(np.isfinite(point.vertices).all() and point.curve.edge_lengths.min() > 0.0)
