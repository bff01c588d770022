"""Steps by second derivatives: the trust-region method of Section 6.4 of [RS21], and the way off a saddle.

A quadratic model of the Lagrangian is minimised within a ball of the metric, in the span of the projected gradient,
the previous projected gradient moved to this tangent space, and, once the gradient is short, the Newton direction: a
blend of Byrd, Schnabel and Shultz (1987) with the two-dimensional subspace method.
"""

import math
from dataclasses import dataclass, field, replace
from functools import partial
from typing import ClassVar

import numpy as np
from scipy.linalg import eigh

from ...arguments import checked_fields, number
from ...energies.components import energy_scale
from ...errors import OptionError
from ...metrics import Metric
from ...types import FloatArray
from ..hessian import LinearMap, lagrangian_hessian, newton_direction
from ..problem import Point
from ..step import Leg, NoStep, Rejected, State, Step, attempt
from .armijo import NOTHING, Armijo, FirstTrial, on_target

ROUNDING = 1e-13  # of the energy: reductions below it cannot be measured, and there the model is believed


@dataclass(frozen=True, eq=False)
class Region:
    """The radius, and the last projected gradient (None at the start)."""

    radius: float
    gradient: FloatArray | None


@checked_fields
@dataclass(frozen=True)
class TrustRegion:
    """Shrink the radius until the step is feasible, free of contact and as good as predicted."""

    newton_threshold: float = number(0.3)  # of √E: longer gradients are not worth a Newton direction
    first_radius: float = number(1.0)  # in the metric's norm
    # accept, good, poor: ratios of actual to predicted reduction: below ``accept`` a step is rejected, above ``good``
    # the radius grows, below ``poor`` it shrinks
    accept: float = 0.05
    good: float = 0.7
    poor: float = 0.25
    first: FirstTrial = field(default_factory=FirstTrial)
    # the search on the way to target lengths, where there is no Lagrangian to model
    underway: Armijo = field(default_factory=Armijo)
    max_trials: int = number(40)
    second_order: ClassVar[bool] = True
    other_metrics: ClassVar[tuple[Metric, ...]] = ()

    def __post_init__(self) -> None:
        if not 0.0 < self.accept <= self.poor < self.good < 1.0:
            raise OptionError(
                f"accept, poor and good are {self.accept}, {self.poor} and {self.good}; they must ascend within (0, 1)"
            )

    def step(self, point: Point, state: State) -> tuple[Step | NoStep, State]:
        if not on_target(point):
            step = self.underway.along(point, -point.gradient, math.inf, state.last_step)
            return step, (State(None, step.size) if isinstance(step, Step) else state)
        region = Region(self.first_radius, None) if state.memory is None else state.memory
        model = _Model.at(point, region.gradient, self.newton_threshold)
        limited_by = None
        for _ in range(self.max_trials):
            s, predicted = model.minimise(region.radius)
            length = point.tangent_space.norm(s)
            if not np.max(np.abs(s)) > NOTHING:
                break
            part, limited_by = self.first(point, s, 1.0)
            if part < 1.0:
                region = replace(region, radius=max(part, 0.1) * length)
                s, predicted = part * s, model.reduction(part * s)
            trial = self._attempt(point, s, predicted)
            if isinstance(trial, Leg):
                radius = self._radius(region.radius, length, _ratio(point, trial.end, predicted))
                return Step((trial,), 1.0, limited_by), State(Region(radius, point.gradient), length)
            limited_by = trial.in_the_way or limited_by
            region = replace(region, radius=self._shorter(trial, min(length, region.radius), length))
        return NoStep.because(limited_by), state

    def _attempt(self, point: Point, s: FloatArray, predicted: float) -> Leg | Rejected:
        return attempt(
            point,
            point.vertices + s,
            np.zeros_like(point.residual),
            lambda q: _ratio(point, q, predicted) >= self.accept,
        )

    def _radius(self, radius: float, length: float, ratio: float) -> float:
        grown = radius * (2.0 if ratio > self.good and length > 0.8 * radius else 1.0)
        return 0.5 * grown if ratio < self.poor else grown

    def _shorter(self, rejected: Rejected, shortest: float, length: float) -> float:
        if rejected.proof is None:
            return 0.4 * shortest
        return self.first.collision_fraction * max(rejected.proof.time, 0.1) * length


def _ratio(point: Point, trial: Point, predicted: float) -> float:
    rounding = ROUNDING * abs(point.energy)
    return (point.energy - trial.energy + rounding) / (predicted + rounding)


@dataclass(frozen=True, eq=False)
class _Model:
    """DE·s + ½ ⟨s, D²L s⟩ on the span of a few vectors, orthonormal in the metric."""

    basis: tuple[FloatArray, ...]
    linear: FloatArray
    quadratic: FloatArray
    point: Point
    hessian: LinearMap

    @classmethod
    def at(cls, point: Point, last_gradient: FloatArray | None, newton_threshold: float) -> "_Model":
        hessian = lagrangian_hessian(point)
        vectors = [-point.gradient]
        threshold = newton_threshold * math.sqrt(energy_scale(point.problem.mesh, point.energy))
        if point.gradient_norm < threshold:
            # superlinear: the inner tolerance goes to 0 with the gradient
            vectors.append(newton_direction(point, hessian, min(0.1, point.gradient_norm / threshold)))
        if last_gradient is not None:
            vectors.append(point.transport(last_gradient))
        basis = _orthonormal(point, vectors)
        images = [hessian(b) for b in basis]
        quadratic = np.array([[np.sum(a * image) for image in images] for a in basis])
        linear = np.array([np.sum(point.derivative * b) for b in basis])
        return cls(basis, linear, 0.5 * (quadratic + quadratic.T), point, hessian)

    def minimise(self, radius: float) -> tuple[FloatArray, float]:
        """The model's minimum in the ball, and the reduction it predicts (a positive number)."""
        c = _minimum_in_ball(self.quadratic, self.linear, radius)
        s = np.sum([ck * b for ck, b in zip(c, self.basis, strict=True)], axis=0)
        return s, -float(self.linear @ c + 0.5 * c @ self.quadratic @ c)

    def reduction(self, s: FloatArray) -> float:
        return -float(np.sum(self.point.derivative * s) + 0.5 * np.sum(s * self.hessian(s)))


def _orthonormal(point: Point, vectors: list[FloatArray]) -> tuple[FloatArray, ...]:
    """Gram–Schmidt in the metric, twice for stability; vectors that add nothing new are left out.

    What is left of a nearly dependent vector is largely its rounding error, which need not be tangent: along its normal
    part the energy changes as along no step.  So the rest is projected before it is made orthogonal once more, and left
    out if little of it remains.
    """
    space, basis = point.tangent_space, list[FloatArray]()
    for vector in vectors:
        for least in (1e-8, 0.5):
            size = space.norm(vector)
            vector = point.transport(vector / size) if size > 0.0 else vector
            for b in basis:
                vector = vector - np.sum(b * space.apply(vector)) * b
            if not space.norm(vector) > least:
                break
        else:
            basis.append(vector / space.norm(vector))
    return tuple(basis)


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


@checked_fields
@dataclass(frozen=True)
class Escape:
    """Halve a step along ± a direction of negative curvature until it lowers the energy and is proved."""

    decrease: float = number(0.1, most=1)  # required fraction of the predicted decrease
    longest: float = number(0.5)  # first step, in the metric's norm
    first: FirstTrial = field(default_factory=FirstTrial)
    max_trials: int = number(20)

    def step(self, point: Point, direction: FloatArray, curvature: float) -> Step | NoStep:
        """Find a step with E(Q) < E(P) + ½ c τ² curvature, c the required decrease.

        The direction, shape (n, m), is tangent and of length 1 in the metric, the curvature ⟨direction, D²L direction⟩
        < 0.
        """
        limited_by = None
        for sign in (1.0, -1.0):
            tau, limited_by = self.first(point, sign * direction, self.longest)
            for _ in range(self.max_trials):
                vertices, level = point.vertices + sign * tau * direction, 0.0 * point.residual
                trial = attempt(point, vertices, level, partial(self.sufficient, point, 0.5 * curvature * tau**2))
                if isinstance(trial, Leg):
                    return Step((trial,), tau, limited_by)
                limited_by = trial.in_the_way or limited_by
                tau *= 0.5
        return NoStep.because(limited_by)

    def sufficient(self, point: Point, predicted: float, trial: Point) -> bool:
        """Whether the energy goes down by enough of what is predicted, a negative number."""
        return trial.energy < point.energy + self.decrease * predicted
