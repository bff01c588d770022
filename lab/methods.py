"""The comparison methods of Section 6.4 of [RS21]: implicit flows, and descent with lengths that only cost a penalty.

They join the others by the entry point ``comparison`` of the group ``mobius_flow.methods``.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import partial
from typing import ClassVar

import numpy as np

from ..core.base import ENERGY_ROUNDING, FloatArray
from ..core.curve import Curve, free_edges
from ..core.descent import Leg, LineSearch, Method, NoStep, Point, SearchState, Step, attempt, on_target
from ..core.descent.directions import ConjugateGradient, LimitedMemoryBFGS
from ..core.descent.geometry import Geometry
from ..core.descent.hessian import energy_hessian, projected_conjugate_gradient
from ..core.descent.line_searches import NOTHING, Armijo, FirstTrial, NormalStep
from ..core.descent.step import Rejected, judged
from ..core.energies import Objective
from ..core.solve.constraints import ConstraintDerivative, Constraints
from ..core.solve.metrics import METRICS, DenseInnerProduct, InnerProduct, Metric, MoebiusMetric
from ..core.solve.saddle import TangentSpace


@dataclass(frozen=True)
class Penalised(Geometry):
    """All polygons that are where their pins are; lengths cost α Σ ℓ⁰ log(ℓ/ℓ⁰)², as in Section 6.4 of [RS21].

    The metric is J + α DΦᵀ I_{L²} DΦ, or J alone where footnote 8 leaves the extension out.
    """

    penalty: float = 1000.0  # α

    def value_and_derivative(
        self, objective: Objective, constraints: Constraints, curve: Curve
    ) -> tuple[float, FloatArray]:
        energy, derivative = objective.value_and_derivative(curve)
        targets = constraints.lengths
        stretch = np.log(curve.edge_lengths / targets)
        weights = self.penalty * targets
        pull = ConstraintDerivative.of_lengths(curve).apply_transpose(2.0 * weights * stretch)
        return energy + float(weights @ stretch**2), derivative + pull

    def tangent_space(
        self, constraints: Constraints, curve: Curve, metric: Metric, inner: InnerProduct
    ) -> TangentSpace:
        # the whole space, but for pins
        penalty = self.penalty if metric.extends_penalty else 0.0
        rows = ConstraintDerivative.of_lengths(curve, constraints.pins.vertices)
        return inner.tangent_space(replace(rows, symmetry=constraints.symmetry), penalty * constraints.lengths)

    def residual(self, constraints: Constraints, curve: Curve) -> FloatArray:  # every polygon is allowed
        return np.zeros(len(free_edges(curve.mesh, constraints.pins.vertices)))


@dataclass(frozen=True)
class WeakWolfe:
    """Widen or halve a bracket until the energy goes down enough and its slope has become flat enough.

    Bisection after Lewis and Overton (Nonsmooth optimization via quasi-Newton methods, 2013): it needs no more than the
    two conditions and ends for every function that is bounded below.
    """

    # decrease, curvature: c₁ < c₂ of the two conditions, for which [RS21] has no numbers. On a parabola they accept
    # steps of 1 − c₂ to 2 (1 − c₁) times the way to its minimum: of twice, with the usual 10⁻⁴, which gain nothing
    decrease: float = 0.25
    curvature: float = 0.9
    first: FirstTrial = field(default_factory=FirstTrial)
    # on the way to target lengths, where these are prescribed
    underway: Armijo = field(default_factory=Armijo)
    max_trials: int = 40

    def along(self, point: Point, direction: FloatArray, natural: float, last: float) -> Step | NoStep:
        """Find a step with E(Q) ≤ E(P) + c₁ τ DE·d and DE(Q)·d ≥ c₂ DE(P)·d, d moved along to Q.

        If contact ends the line before the second condition holds, the longest step found is taken.  Parameters are
        those of `Armijo.along`.
        """
        if not on_target(point):
            return self.underway.along(point, direction, natural, last)
        end, limited_by = self.first(point, direction, math.inf)
        slope = float(np.sum(point.derivative * direction))
        low, high = 0.0, math.inf
        best: Step | None = None
        tau = min(natural, self.first.growth * last if math.isfinite(last) else 1.0, end)
        for _ in range(self.max_trials):
            if not tau * np.max(np.abs(direction)) > NOTHING:
                break
            # differences below the rounding of the energy count as none
            most = point.energy + self.decrease * tau * slope + ENERGY_ROUNDING * abs(point.energy)
            acceptable = partial(lambda most, trial: trial.energy <= most, most)
            trial = attempt(point, point.vertices + tau * direction, point.residual, acceptable)
            if isinstance(trial, Leg):
                best, low = Step((trial,), tau, limited_by), tau
                flat = np.sum(trial.end.derivative * trial.end.transport(direction)) >= self.curvature * slope
                if flat or tau >= end:
                    break
            else:
                high, limited_by = tau, trial.in_the_way or limited_by
            tau = min(end, 2.0 * low) if math.isinf(high) else 0.5 * (low + high)
        return NoStep.because(limited_by) if best is None else best


@dataclass(frozen=True)
class Accelerated:
    """Nesterov's accelerated gradient: y = x + β (x − x_last), then x_next = y − τ u(y).

    (Yu. Nesterov, A method for solving the convex programming problem with convergence rate O(1/k²), 1983.)  Both
    sub-steps are truncated by collision detection, and the momentum is reset when the objective goes up (O'Donoghue and
    Candès, Adaptive restart for accelerated gradient schemes, 2015).
    """

    search: WeakWolfe = field(default_factory=WeakWolfe)  # finds τ
    second_order: ClassVar[bool] = False
    other_metrics: ClassVar[tuple[Metric, ...]] = ()

    def step(self, point: Point, state: SearchState) -> tuple[Step | NoStep, SearchState]:
        """Extrapolate, then take a gradient step from there; the path has both legs.

        The memory are the vertices before, and Nesterov's t_k.
        """
        before, last = (point.vertices, 1.0) if state.memory is None else state.memory
        t = 0.5 * (1.0 + math.sqrt(1.0 + 4.0 * last**2))
        momentum = (last - 1.0) / t * (point.vertices - before)
        part, _ = self.search.first(point, momentum, 1.0)
        end = point.vertices + part * momentum
        first = attempt(point, end, point.residual, lambda q: True) if part else Rejected()
        start = first.end if isinstance(first, Leg) else point
        step = self.search.along(start, -start.gradient, np.inf, state.last_step)
        if isinstance(step, NoStep):
            return (step, state) if state.memory is None else self.step(point, replace(state, memory=None))
        if isinstance(first, Leg):
            step = replace(step, legs=(first, *step.legs))
        rising = step.point.energy > point.energy
        return step, SearchState(None if rising else (point.vertices, t), step.size)


@dataclass(frozen=True)
class BackwardEuler:
    """Halve τ until the equations are solved, Armijo's rule holds and the motion is proved.

    With S_P the projected-gradient operator of (41) at P, one step of size τ is the tangent vector w with

        w + τ S_P DE(Q(w)) = 0,   Q(w) the feasible point that P + w leads to by (42),

    constraint forces being those of P (as in the SHAKE scheme of mechanics).  Newton's method solves it, projected
    conjugate gradients its linear systems, preconditioned by A/τ + J_C.
    """

    # the metric that is added to the flow's own, divided by τ, for Newton's method and the way to the constraints
    preconditioner: Metric = field(default_factory=MoebiusMetric)
    # first_step, growth: τ of the first step, and how much longer than the last one a step may be
    first_step: float = 0.1
    growth: float = 2.0
    # newton_iterations, newton_tolerance: of Newton's method, relative to the first residual: a step need not be more
    # exact than the time discretisation
    newton_iterations: int = 8
    newton_tolerance: float = 1e-3
    # krylov_iterations, krylov_tolerance: of its linear systems
    krylov_iterations: int = 60
    krylov_tolerance: float = 0.05
    armijo: Armijo = field(default_factory=Armijo)  # Armijo's rule
    second_order: ClassVar[bool] = True

    @property
    def other_metrics(self) -> tuple[Metric, ...]:
        return (self.preconditioner,)

    def step(self, point: Point, state: SearchState) -> tuple[Step | NoStep, SearchState]:
        """Take one step; the memory is the last τ.

        A share of the way to the target lengths is taken along, if they are not reached yet.  Feasibility is restored
        in the preconditioner's metric: in a weak one like L² the shortest way back is too rough (footnote 7 of [RS21]).
        """
        tau = self.first_step if state.memory is None else self.growth * state.memory
        own, flow = point.inner_product, point.tangent_space
        preconditioner, share, limited_by = self.preconditioner.at(point.curve), 1.0, None
        for _ in range(self.armijo.max_trials):
            both = DenseInnerProduct(preconditioner.dense() + 1.0 / tau * own.dense())
            space = both.tangent_space(flow.constraints)
            normal = NormalStep.at(point, space)
            base = point.vertices + share * normal.longest * normal.full
            level = (1.0 - share * normal.longest) * point.residual
            w, first, last, solved = np.zeros_like(point.vertices), 0.0, math.inf, None
            for _ in range(self.newton_iterations):  # for w + τ S_P DE(Q(w)) = 0
                trial = point.retract(base + w, level, space)
                if trial is None or not math.isfinite(trial.energy):
                    break
                right = -(trial.derivative + flow.apply(w) / tau)
                size = math.sqrt(max(0.0, float(np.sum(right * space.gradient(right)[0]))))
                first = first or size
                if size <= self.newton_tolerance * first:
                    solved = trial
                if solved or not size < 2.0 * last:
                    break
                last = size
                implicit = partial(lambda h, tau, v: h(v) + flow.apply(v) / tau, energy_hessian(trial), tau)
                most, tolerance = self.krylov_iterations, self.krylov_tolerance
                w += projected_conjugate_gradient(implicit, right, space, tolerance, most)
            if solved is not None:
                slope = float(np.sum(point.derivative * (solved.vertices - point.vertices)))
                if slope > 0.0 and share * normal.longest > normal.least:
                    share *= 0.25  # the way to the target lengths costs more than the flow gains
                    continue
                judgement = judged(point, solved, partial(self.armijo.sufficient, point, slope, 0.0))
                if isinstance(judgement, Leg):
                    return Step((judgement,), tau, limited_by), SearchState(tau, tau)
                limited_by = judgement.in_the_way or limited_by
            tau *= 0.5
            share *= 0.5
        return NoStep.because(limited_by), state


def _all() -> Iterator[Method]:
    for name, metric in METRICS.items():
        text = f"projected gradient flow, implicit, {metric.description}"
        label = f"Implicit Flow in {metric.description}"
        yield Method(f"implicit-{name}", text, BackwardEuler(), metric, label=label, comparison=True)
    wolfe, geometry = WeakWolfe(), Penalised()
    for name, text, title, steps in (
        ("lbfgs", "L-BFGS", "L-BFGS", LineSearch(LimitedMemoryBFGS(history=30), wolfe)),
        ("cg", "conjugate gradients (PR+)", "Conjugate Gradients", LineSearch(ConjugateGradient(), wolfe)),
        ("nesterov", "Nesterov's accelerated gradient", "Nesterov's Accelerated Gradient", Accelerated(wolfe)),
    ):
        label, text = f"{title} with Length Penalty", f"{text} on the penalised energy"
        yield Method(f"penalty-{name}", text, steps, geometry=geometry, label=label, comparison=True)


COMPARISON = {method.name: method for method in _all()}
