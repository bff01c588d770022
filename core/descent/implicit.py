"""Projected gradient flows, implicit in time: backward Euler with Armijo backtracking (Section 6.4 of [RS21]).

With S_P the projected-gradient operator of (41) at P, one step of size τ is the tangent vector w with

    w + τ S_P DE(Q(w)) = 0,   Q(w) the feasible point that P + w leads to by (42),

constraint forces being those of P (as in the SHAKE scheme of mechanics).  Newton's method solves it, projected
conjugate gradients its linear systems, preconditioned by A/τ + J_C.
"""

import math
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from ..metrics import Metric, MoebiusMetric
from ..saddle import SaddleSolver
from .feasibility import restore
from .method import State
from .newton import energy_hessian, projected_conjugate_gradient
from .problem import Point
from .search import MAX_TRIALS, SMALL_SHARE, NormalStep, sufficient
from .step import NoStep, Step, leg

FIRST_STEP = 0.1
STEP_GROWTH = 2.0
NEWTON_ITERATIONS = 8
NEWTON_TOLERANCE = 1e-3  # of the first residual: the step need not be more exact than the time discretisation
KRYLOV_TOLERANCE = 0.05
KRYLOV_ITERATIONS = 60


@dataclass(frozen=True)
class ImplicitFlow:
    """Backward Euler for the gradient flow in a metric."""

    name: str
    description: str
    metric: Metric
    penalty: ClassVar[None] = None
    second_order: ClassVar[bool] = True
    preconditioner: MoebiusMetric = field(default_factory=MoebiusMetric)

    def step(self, point: Point, state: State) -> tuple[Step | NoStep, State]:
        """Halve τ until the equations are solved, Armijo's rule holds and the motion is free of contact."""
        tau = FIRST_STEP if state.memory is None else STEP_GROWTH * state.memory
        preconditioner = self.preconditioner.matrix(point.curve)
        share = 1.0
        limited_by = None
        for _ in range(MAX_TRIALS):
            solver = SaddleSolver(point.saddle.matrix / tau + preconditioner, point.saddle.constraints)
            trial = _backward_euler(point, tau, share, solver)
            if trial is not None:
                slope = float(np.sum(point.derivative * (trial.vertices - point.vertices)))
                if slope > 0.0 and share > SMALL_SHARE:
                    share *= 0.25  # the way to the target lengths costs more than the flow gains
                    continue
                if sufficient(trial.energy - point.energy, slope, point.energy):
                    motion = leg(point, trial)
                    if motion.open:
                        return Step((motion,), tau, limited_by), State(tau, tau)
                    limited_by = motion.proof.pair
            tau *= 0.5
            share *= 0.5
        return NoStep.because(limited_by), state


def _backward_euler(point: Point, tau: float, share: float, solver: SaddleSolver) -> Point | None:
    """Solve for the next point, None if Newton's method does not get there.

    ``share`` of the way to the target lengths is taken along, if they are not reached yet.  Feasibility is restored in
    the preconditioner's metric: in a weak one like L² the shortest way back is too rough (footnote 7 of [RS21]).
    """
    normal = NormalStep.at(point, solver)
    base = point.vertices + share * normal.longest * normal.full
    level = (1.0 - share * normal.longest) * point.residual
    w = np.zeros_like(point.vertices)
    first, last = 0.0, math.inf
    for _ in range(NEWTON_ITERATIONS):
        trial = restore(point, base + w, level, solver)
        if trial is None or not math.isfinite(trial.energy):
            return None
        right = -(trial.derivative + point.saddle.apply_metric(w) / tau)
        size = math.sqrt(max(0.0, float(np.sum(right * solver.gradient(right)[0]))))
        first = first or size
        if size <= NEWTON_TOLERANCE * first:
            return trial
        if not size < 2.0 * last:
            return None
        last = size
        of_energy = energy_hessian(trial)
        w = w + projected_conjugate_gradient(
            lambda v, h=of_energy: h(v) + point.saddle.apply_metric(v) / tau,  # type: ignore[misc]
            right,
            solver,
            KRYLOV_TOLERANCE,
            KRYLOV_ITERATIONS,
        )
    return None
