"""Projected gradient flows, implicit in time: backward Euler with Armijo backtracking (Section 6.4 of [RS21]).

With S_P the projected-gradient operator of (41) at P, one step of size τ is the tangent vector w with

    w + τ S_P DE(Q(w)) = 0,   Q(w) the feasible point that P + w leads to by (42),

constraint forces being those of P (as in the SHAKE scheme of mechanics).  Newton's method solves it, projected
conjugate gradients its linear systems, preconditioned by A/τ + J_C.
"""

import math
from dataclasses import dataclass, field
from functools import partial
from typing import ClassVar

import numpy as np

from ...checks import check_fields
from ...metrics import Metric, MoebiusMetric
from ...saddle import TangentSpace
from ..hessian import energy_hessian, projected_conjugate_gradient
from ..problem import Point
from ..step import Leg, NoStep, State, Step, judged
from .armijo import Armijo


@dataclass(frozen=True)
class BackwardEuler:
    """Halve τ until the equations are solved, Armijo's rule holds and the motion is proved.

    Parameters
    ----------
    preconditioner
        The metric that is added to the flow's own, divided by τ, for Newton's method and the way to the constraints.
    first_step, growth
        τ of the first step, and how much longer than the last one a step may be.
    newton_iterations, newton_tolerance
        Of Newton's method, relative to the first residual: a step need not be more exact than the time discretisation.
    krylov_iterations, krylov_tolerance
        Of its linear systems.
    armijo
        Armijo's rule, and how fast lengths go to their targets.
    """

    preconditioner: Metric = field(default_factory=MoebiusMetric)
    first_step: float = 0.1
    growth: float = 2.0
    newton_iterations: int = 8
    newton_tolerance: float = 1e-3
    krylov_iterations: int = 60
    krylov_tolerance: float = 0.05
    armijo: Armijo = field(default_factory=Armijo)
    second_order: ClassVar[bool] = True

    def __post_init__(self) -> None:
        positive = (0.0, math.inf)
        check_fields(self, first_step=positive, growth=(1.0, math.inf), newton_iterations=positive)
        check_fields(self, newton_tolerance=(0.0, 1.0), krylov_iterations=positive, krylov_tolerance=(0.0, 1.0))

    @property
    def other_metrics(self) -> tuple[Metric, ...]:
        """The preconditioner."""
        return (self.preconditioner,)

    def step(self, point: Point, state: State) -> tuple[Step | NoStep, State]:
        """Take one step."""
        tau = self.first_step if state.memory is None else self.growth * state.memory
        own, constraints = point.inner_product, point.tangent_space.constraints
        preconditioner = self.preconditioner.at(point.curve)
        share = 1.0
        limited_by = None
        for _ in range(self.armijo.max_trials):
            space = preconditioner.plus(own, 1.0 / tau).tangent_space(constraints)
            solved = self._solved(point, tau, share, space)
            if solved is not None:
                slope = float(np.sum(point.derivative * (solved.vertices - point.vertices)))
                if slope > 0.0 and share > self.armijo.lengths.least_share:
                    share *= 0.25  # the way to the target lengths costs more than the flow gains
                    continue
                trial = judged(point, solved, partial(self.armijo.sufficient, point, slope, 0.0))
                if isinstance(trial, Leg):
                    return Step((trial,), tau, limited_by), State(tau, tau)
                limited_by = trial.in_the_way or limited_by
            tau *= 0.5
            share *= 0.5
        return NoStep.because(limited_by), state

    def _solved(self, point: Point, tau: float, share: float, space: TangentSpace) -> Point | None:
        """Solve for the next point, None if Newton's method does not get there.

        ``share`` of the way to the target lengths is taken along, if they are not reached yet.  Feasibility is restored
        in the preconditioner's metric: in a weak one like L² the shortest way back is too rough (footnote 7 of [RS21]).
        """
        normal = self.armijo.lengths.at(point, space)
        base = point.vertices + share * normal.longest * normal.full
        level = (1.0 - share * normal.longest) * point.residual
        w = np.zeros_like(point.vertices)
        first, last = 0.0, math.inf
        for _ in range(self.newton_iterations):
            trial = point.retract(base + w, level, space)
            if trial is None or not math.isfinite(trial.energy):
                return None
            right = -(trial.derivative + point.tangent_space.apply(w) / tau)
            size = math.sqrt(max(0.0, float(np.sum(right * space.gradient(right)[0]))))
            first = first or size
            if size <= self.newton_tolerance * first:
                return trial
            if not size < 2.0 * last:
                return None
            last = size
            of_energy = energy_hessian(trial)
            w = w + projected_conjugate_gradient(
                lambda v, h=of_energy: h(v) + point.tangent_space.apply(v) / tau,  # type: ignore[misc]
                right,
                space,
                self.krylov_tolerance,
                self.krylov_iterations,
            )
        return None
