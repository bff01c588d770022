"""The trust-region method of Section 6.4 of [RS21].

A quadratic model of the Lagrangian is minimised within a ball of the metric, in the span of the projected gradient,
the previous projected gradient moved to this tangent space, and, once the gradient is short, the Newton direction: a
blend of Byrd, Schnabel and Shultz (1987) with the two-dimensional subspace method.
"""

import math
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from scipy.linalg import eigh

from ..metrics import Metric
from ..types import FloatArray
from .feasibility import restore
from .method import State
from .newton import LinearMap, lagrangian_hessian, newton_direction
from .problem import Point
from .search import COLLISION_FRACTION, FEASIBLE, MAX_TRIALS, armijo_step, free_step
from .step import NoStep, Step, leg

NEWTON_THRESHOLD = 0.3  # of √E: longer gradients are not worth a Newton direction
FIRST_RADIUS = 1.0
ACCEPT, GOOD = 0.05, 0.7  # of actual to predicted reduction


@dataclass(frozen=True, eq=False)
class Memory:
    """The radius, and the last projected gradient (None at the start)."""

    radius: float
    gradient: FloatArray | None


@dataclass(frozen=True)
class TrustRegion:
    """Subspace trust region on the constraint manifold."""

    name: str
    description: str
    metric: Metric
    penalty: ClassVar[None] = None
    second_order: ClassVar[bool] = True

    def step(self, point: Point, state: State) -> tuple[Step | NoStep, State]:
        """Shrink the radius until the step is feasible, free of contact and as good as predicted."""
        if np.max(np.abs(point.residual)) > FEASIBLE:
            # on the way to the target lengths there is no Lagrangian to model
            step = armijo_step(point, -point.gradient, 4.0 * state.last_step)
            return step, (State(None, step.size) if isinstance(step, Step) else state)
        memory = Memory(FIRST_RADIUS, None) if state.memory is None else state.memory
        model = _Model.at(point, memory.gradient)
        limited_by = None
        for _ in range(MAX_TRIALS):
            s, predicted = model.minimise(memory.radius)
            length = point.saddle.norm(s)
            if not np.max(np.abs(s)) > 1e-15:
                break
            part, limited_by = free_step(point, s, 1.0)
            if part < 1.0:
                memory = replace(memory, radius=max(part, 0.1) * length)
                s, predicted = part * s, model.reduction(part * s)
            trial, ratio = _trial(point, s, predicted)
            if trial is not None and ratio >= ACCEPT:
                motion = leg(point, trial)
                if motion.open:
                    radius = memory.radius * (2.0 if ratio > GOOD and length > 0.8 * memory.radius else 1.0)
                    radius = 0.5 * radius if ratio < 0.25 else radius
                    return Step((motion,), 1.0, limited_by), State(Memory(radius, point.gradient), length)
                limited_by = motion.proof.pair
                memory = replace(memory, radius=COLLISION_FRACTION * max(motion.proof.time, 0.1) * length)
            else:
                memory = replace(memory, radius=0.4 * min(length, memory.radius))
        return NoStep.because(limited_by), state


def _trial(point: Point, s: FloatArray, predicted: float) -> tuple[Point | None, float]:
    """The feasible point that P + s leads to, and the ratio of actual to predicted reduction."""
    trial = restore(point, point.vertices + s, np.zeros_like(point.residual))
    if trial is None or not math.isfinite(trial.energy):
        return None, 0.0
    # reductions below the rounding of the energy cannot be measured: there the model is believed
    rounding = 1e-13 * abs(point.energy)
    return trial, (point.energy - trial.energy + rounding) / (predicted + rounding)


@dataclass(frozen=True, eq=False)
class _Model:
    """DE·s + ½ ⟨s, D²L s⟩ on the span of a few vectors, orthonormal in the metric."""

    basis: tuple[FloatArray, ...]
    linear: FloatArray
    quadratic: FloatArray
    point: Point
    hessian: LinearMap

    @classmethod
    def at(cls, point: Point, last_gradient: FloatArray | None) -> "_Model":
        """The model at a point."""
        hessian = lagrangian_hessian(point)
        vectors = [-point.gradient]
        threshold = NEWTON_THRESHOLD * math.sqrt(abs(point.energy))
        if point.gradient_norm < threshold:
            # superlinear: the inner tolerance goes to 0 with the gradient
            vectors.append(newton_direction(point, hessian, min(0.1, point.gradient_norm / threshold)))
        if last_gradient is not None:
            vectors.append(point.saddle.project(last_gradient))
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
        """Predicted reduction of a vector of the span."""
        return -float(np.sum(self.point.derivative * s) + 0.5 * np.sum(s * self.hessian(s)))


def _orthonormal(point: Point, vectors: list[FloatArray]) -> tuple[FloatArray, ...]:
    """Gram–Schmidt in the metric, twice for stability; vectors that add nothing new are left out."""
    basis: list[FloatArray] = []
    for vector in vectors:
        size = point.saddle.norm(vector)
        if size == 0.0:
            continue
        v = vector / size
        for _ in range(2):
            for b in basis:
                v = v - np.sum(b * point.saddle.apply_metric(v)) * b
        rest = point.saddle.norm(v)
        if rest > 1e-8:
            basis.append(v / rest)
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
