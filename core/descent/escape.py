"""A step away from a saddle, along a direction of negative curvature."""

import math

import numpy as np

from ..types import FloatArray
from .feasibility import restore
from .problem import Point
from .search import free_step
from .step import NoStep, Step, leg

FIRST_STEP = 0.5  # in the metric's norm
MAX_TRIALS = 20


def escape_step(point: Point, direction: FloatArray, curvature: float) -> Step | NoStep:
    """Find a certified step along ± a direction of negative curvature that lowers the energy.

    Parameters
    ----------
    direction
        Tangent vector of length 1 in the metric; shape (n, m).
    curvature
        ⟨direction, D²L direction⟩ < 0; a tenth of the predicted decrease is asked for.
    """
    limited_by = None
    for sign in (1.0, -1.0):
        tau, limited_by = free_step(point, sign * direction, FIRST_STEP)
        for _ in range(MAX_TRIALS):
            trial = restore(point, point.vertices + sign * tau * direction, np.zeros_like(point.residual))
            wanted = point.energy + 0.1 * 0.5 * curvature * tau**2
            if trial is not None and math.isfinite(trial.energy) and trial.energy < wanted:
                motion = leg(point, trial)
                if motion.open:
                    return Step((motion,), tau, limited_by)
                limited_by = motion.proof.pair
            tau *= 0.5
    return NoStep.because(limited_by)
