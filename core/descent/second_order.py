"""Steps by second derivatives: the trust region of Section 6.4 of [RS21], the way off a saddle, the quadratic end.

Near a minimum J_C⁻¹ D²L has a few eigenvalues far below its bulk, those of Möbius maps being some 11/N²: in the metric
hundreds of steps crawl along their valleys.  With a multiple of the metric that makes it positive definite on the
tangent space, D²L + σ J_C is assembled, which is as dear as a few steps, and factorised; the next steps share it, and
the pairs of L-BFGS tell what changes on the way (`Newton`).  Newton's method it is where one step suffices.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import partial
from typing import ClassVar

import numpy as np
from scipy.linalg import eigh

from ..base import ENERGY_ROUNDING, FloatArray, check_time
from ..energies.components import energy_scale
from ..energies.energy import Approximate
from ..solve.metrics import Metric
from ..solve.saddle.indefinite import Chains, FactorisedHessian
from .directions import LimitedMemoryBFGS
from .hessian import ASSEMBLED_SIZE, lagrangian_hessian, lagrangian_matrix, projected_conjugate_gradient
from .line_searches import NOTHING, Armijo, FirstTrial, LineSearch, on_target
from .problem import Point
from .step import Leg, NoStep, SearchState, Step, attempt


@dataclass(frozen=True)
class TrustRegion:
    """Shrink the radius until the step is feasible, free of contact and as good as predicted.

    A quadratic model of the Lagrangian is minimised within a ball of the metric, in the span of the projected gradient,
    the previous projected gradient moved to this tangent space, and, once the gradient is short, the Newton direction:
    a blend of Byrd, Schnabel and Shultz, A trust region algorithm for nonlinearly constrained optimization (1987), with
    the two-dimensional subspaces of Shultz, Schnabel and Byrd, A family of trust-region-based algorithms (1985).
    """

    newton_threshold: float = 0.3  # of √E: longer gradients are not worth a Newton direction
    first_radius: float = 1.0  # in the metric's norm
    # accept ≤ poor < good: ratios of actual to predicted reduction: below ``accept`` a step is rejected, above ``good``
    # the radius grows, below ``poor`` it shrinks
    accept: float = 0.05
    good: float = 0.7
    poor: float = 0.25
    first: FirstTrial = field(default_factory=FirstTrial)
    # the search on the way to target lengths, where there is no Lagrangian to model
    underway: Armijo = field(default_factory=Armijo)
    max_trials: int = 40
    second_order: ClassVar[bool] = True
    other_metrics: ClassVar[tuple[Metric, ...]] = ()

    def step(self, point: Point, state: SearchState) -> tuple[Step | NoStep, SearchState]:
        """Take one step; the memory is the radius, and the last projected gradient."""
        if not on_target(point):
            step = self.underway.along(point, -point.gradient, math.inf, state.last_step)
            return step, (SearchState(None, step.size) if isinstance(step, Step) else state)
        radius, last = (self.first_radius, None) if state.memory is None else state.memory
        space, limited_by = point.tangent_space, None
        # the model DE·s + ½ ⟨s, D²L s⟩ on the span of a few vectors, orthonormal in the metric
        hessian, vectors = lagrangian_hessian(point), [-point.gradient]
        threshold = self.newton_threshold * math.sqrt(energy_scale(point.problem.mesh, point.energy))
        if point.gradient_norm < threshold:
            # Newton's direction, superlinear: the inner tolerance goes to 0 with the gradient
            inner = min(0.1, point.gradient_norm / threshold)
            vectors.append(projected_conjugate_gradient(hessian, -point.derivative, space, inner, 200))
        if last is not None:
            vectors.append(point.transport(last))
        # Gram–Schmidt in the metric, twice for stability; vectors that add nothing new are left out.  What is left of a
        # nearly dependent vector is largely its rounding error, which need not be tangent: along its normal part the
        # energy changes as along no step.  So the rest is projected before it is made orthogonal once more.
        rows = list[FloatArray]()
        for vector in vectors:
            for least in (1e-8, 0.5):
                size = space.norm(vector)
                vector = point.transport(vector / size) if size > 0.0 else vector
                for known in rows:
                    vector = vector - np.sum(known * space.apply(vector)) * known
                if not space.norm(vector) > least:
                    break
            else:
                rows.append(vector / space.norm(vector))
        basis = np.array(rows)
        images = np.array([hessian(b) for b in basis])
        linear, quadratic = np.einsum("kij,ij->k", basis, point.derivative), np.einsum("kij,lij->kl", basis, images)
        quadratic = 0.5 * (quadratic + quadratic.T)
        # reductions below some roundings of the energy cannot be measured: there the model is believed
        rounding = 10.0 * ENERGY_ROUNDING * abs(point.energy)

        def ratio(trial: Point, predicted: float) -> float:
            return (point.energy - trial.energy + rounding) / (predicted + rounding)

        for _ in range(self.max_trials):
            c = _minimum_in_ball(quadratic, linear, radius)
            s = np.einsum("k,kij->ij", c, basis)
            length = space.norm(s)
            if not np.max(np.abs(s)) > NOTHING:
                break
            part, limited_by = self.first(point, s, 1.0)
            if part < 1.0:
                radius = max(part, 0.1) * length
                c, s = part * c, part * s
            predicted = -float(linear @ c + 0.5 * c @ quadratic @ c)
            acceptable = partial(lambda predicted, trial: ratio(trial, predicted) >= self.accept, predicted)
            trial = attempt(point, point.vertices + s, np.zeros_like(point.residual), acceptable)
            if isinstance(trial, Leg):
                if ratio(trial.end, predicted) < self.poor:
                    radius *= 0.5
                elif ratio(trial.end, predicted) > self.good and length > 0.8 * radius:
                    radius *= 2.0
                return Step((trial,), 1.0, limited_by), SearchState((radius, point.gradient), length)
            limited_by = trial.in_the_way or limited_by
            if trial.proof is None:
                radius = 0.4 * min(length, radius)
            else:
                radius = self.first.collision_fraction * max(trial.proof.time, 0.1) * length
        return NoStep.because(limited_by), state


def _minimum_in_ball(q: FloatArray, g: FloatArray, radius: float) -> FloatArray:
    """Minimise g·c + ½ c·q c over |c| ≤ radius for a small matrix, exactly: (q + σ) c = −g with the right σ ≥ 0."""
    values, vectors = eigh(q)
    h = vectors.T @ g
    if values[0] > 0.0 and np.linalg.norm(h / values) <= radius:
        return np.asarray(-vectors @ (h / values))
    low, high = max(0.0, -values[0]), max(0.0, -values[0]) + np.linalg.norm(g) / radius + abs(values[-1])
    for _ in range(200):
        sigma = 0.5 * (low + high)
        with np.errstate(divide="ignore", invalid="ignore"):
            longer = not np.linalg.norm(h / (values + sigma)) <= radius
        low, high = (sigma, high) if longer else (low, sigma)
    c = -h / (values + high)
    missing = radius**2 - float(c @ c)
    if values[0] < 0.0 and missing > 1e-10 * radius**2:  # the hard case: go on along the lowest eigenvector
        c[0] += math.copysign(math.sqrt(missing), c[0])
    return np.asarray(vectors @ c)


def step_off(
    point: Point, direction: FloatArray, curvature: float, decrease: float = 0.1, longest: float = 0.5, most: int = 20
) -> Step | NoStep:
    """Halve a step along ± a direction of negative curvature until it lowers the energy enough and is proved.

    E(Q) < E(P) + ½ c τ² curvature, c the required part of the predicted decrease.  The direction, shape (n, m), is
    tangent and of length 1 in the metric, as the ``longest`` step is, and the curvature ⟨direction, D²L direction⟩ < 0.
    """
    limited_by = None
    for sign in (1.0, -1.0):
        tau, limited_by = FirstTrial()(point, sign * direction, longest)
        for _ in range(most):
            bound = point.energy + 0.5 * decrease * curvature * tau**2
            lower = partial(lambda bound, trial: trial.energy < bound, bound)
            trial = attempt(point, point.vertices + sign * tau * direction, 0.0 * point.residual, lower)
            if isinstance(trial, Leg):
                return Step((trial,), tau, limited_by)
            limited_by = trial.in_the_way or limited_by
            tau *= 0.5
    return NoStep.because(limited_by)


class Curvature:
    """The Lagrangian's second derivative at a point, on the tangent space, against the metric there.

    Under a symmetry it is the metric on all directions that break it, so that they neither count nor are gone.
    """

    def __init__(self, point: Point) -> None:
        check_time()
        self.point, self._chains = point, Chains(point.tangent_space.constraints)
        gram = point.inner_product.dense()
        hessian = self.point.problem.constraints.symmetry.within(lagrangian_matrix(point), gram)
        half = self._chains.of_forces(hessian)  # in the unknowns of chains, on one side
        self._hessian = self._chains.of_forces(np.ascontiguousarray(half.T))
        self._metric = self._chains.of_metric(gram)

    @staticmethod
    def is_known(point: Point) -> bool:
        """Whether there is one, exact and small enough to be factorised."""
        objective = point.problem.objective
        exact = objective.is_assembled and not isinstance(objective.energy, Approximate)
        return exact and point.problem.geometry.prescribes and point.vertices.size <= ASSEMBLED_SIZE

    def shifted(self, shift: float) -> FactorisedHessian:
        """D²L + σ J for a shift σ; as many of its eigenvalues are negative as D²L has below −σ against J."""
        check_time()
        return FactorisedHessian(self._hessian + shift * self._metric, self._chains)

    def gain(self, inverse: FactorisedHessian) -> float:
        """The decrease of the energy that a quadratic model promises, half the square of Newton's decrement."""
        return 0.5 * float(np.sum(self.point.derivative * inverse.solve(self.point.derivative)))


@dataclass(frozen=True)
class Newton:
    """Steps that share one second derivative."""

    factor: float = 8.0  # by which σ grows until the Hessian is positive definite
    steps: int = 8
    short: float = 0.3  # part of a step that shows that the model is not to be trusted so far
    # full steps gain half of what their slope promises, and so must not be asked for that
    search: Armijo = field(default_factory=lambda: Armijo(decrease=0.1))

    def definite(self, curvature: Curvature, shift: float) -> tuple[FactorisedHessian, int, float]:
        """The factors for the first σ, from a given one on, that makes it so, the index at the given one, and σ.

        Raises LinAlgError if none does, which rounding alone can bring about.
        """
        inverse = curvature.shifted(shift)
        index = inverse.negative
        while inverse.negative:
            shift *= self.factor
            if not shift < 1e6:
                raise np.linalg.LinAlgError("no multiple of the metric makes the second derivative definite")
            inverse = curvature.shifted(shift)
        return inverse, index, shift

    def along(
        self, curvature: Curvature, inverse: FactorisedHessian, shift: float, most: int, least: float
    ) -> Iterator[Step]:
        """At most so many steps, until one gains less than ``least`` or none is found; where one is short σ grows."""
        point, state = curvature.point, SearchState()
        for _ in range(min(most, self.steps)):
            rule = LineSearch(LimitedMemoryBFGS(inverse=inverse.solve), self.search, self.steps)
            step, state = rule.step(point, state)
            if not isinstance(step, Step):
                return
            yield step
            if point.energy - step.point.energy < least:
                return
            point = step.point
            if step.size < self.short:
                inverse, _, shift = self.definite(curvature, self.factor * shift)
                state = SearchState()
