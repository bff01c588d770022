"""Descent methods: geometry × metric × the rule for steps, one registry line each.

A geometry is the set that iterates lie on: polygons of prescribed lengths, or all polygons, lengths costing a penalty.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from ..base import FloatArray, Table
from ..curve import Curve
from ..solve.metrics import METRICS, InnerProduct, Metric, MoebiusMetric
from ..solve.saddle import TangentSpace
from .directions import ConjugateGradient, LimitedMemoryBFGS, SteepestDescent
from .line_searches import Armijo, FirstTrial, LineSearch
from .problem import Point, Problem
from .second_order import TrustRegion
from .step import NoStep, SearchState, Step

_GRADIENTS = "projected fractional Sobolev gradients"


@dataclass(frozen=True)
class Geometry(ABC):
    """The set that iterates lie on, its tangent spaces, and the ways from these back to the set."""

    penalty: float | None = None  # α, what errors of lengths cost; None where lengths are prescribed

    @property
    def prescribes(self) -> bool:
        """Whether lengths are prescribed, so that there are multipliers and a residual."""
        return self.penalty is None

    @abstractmethod
    def value_and_derivative(self, problem: Problem, curve: Curve) -> tuple[float, FloatArray]:
        """What is minimised on the set, and its derivative, shape (n, m)."""

    @abstractmethod
    def tangent_space(self, problem: Problem, curve: Curve, inner: InnerProduct) -> TangentSpace:
        """Where directions at a curve lie, with the metric there."""

    @abstractmethod
    def residual(self, problem: Problem, curve: Curve) -> FloatArray:
        """How far a curve is from the set; shape (rows of the constraints,)."""

    @abstractmethod
    def retract(self, base: Point, vertices: FloatArray, level: FloatArray, space: TangentSpace) -> Point | None:
        """Find a point near ``vertices`` with the residual ``level``; None if there is none in reach."""

    @abstractmethod
    def transport(self, point: Point, u: FloatArray) -> FloatArray:
        """A vector of another tangent space moved to that of a point; shape (n, m)."""


@dataclass(frozen=True)
class Constrained(Geometry):
    """The manifold {Φ = 0}, to which (42) of [RS21] leads back after a step."""

    # of lengths, a relative error, and of barycenters: far below any gap that can be proved
    tolerance: float = 1e-11
    max_iterations: int = 15  # of the modified Newton method (42), and of Newton's for what it leaves over
    # change of an edge vector, relative to its length, up to which `TangentSpace.restoration` is as good as the
    # shortest way back in the metric, and far cheaper. Larger corrections should know where other strands are, not
    # turn edges that are much shorter than others, and not cost the energy the step has gained
    small: float = 1e-3
    # least rate of both; where it is slower, a shorter step is cheaper than more iterations
    contraction: float = 0.6

    def value_and_derivative(self, problem: Problem, curve: Curve) -> tuple[float, FloatArray]:
        return problem.objective.value_and_derivative(curve)

    def tangent_space(self, problem: Problem, curve: Curve, inner: InnerProduct) -> TangentSpace:
        return inner.tangent_space(problem.constraints.derivative(curve))

    def residual(self, problem: Problem, curve: Curve) -> FloatArray:
        return problem.constraints.residual(curve)

    def retract(self, base: Point, vertices: FloatArray, level: FloatArray, space: TangentSpace) -> Point | None:
        """Find Q near ``vertices`` with Φ(Q) = ``level`` by Q ← Q − C(P)^† (Φ(Q) − level), P the base point: (42).

        Once corrections are small the derivative is that at Q and the pseudo-inverse one that is cheap, by which the
        residual vanishes quadratically.  There is always a correction: many short steps, each within the tolerance,
        would drift away together, and what lengths gain or lose by that is energy which searches take for the step's.
        None if the residual does not contract: the step was too long.
        """
        last = np.inf
        for corrections in range(self.max_iterations):
            point = base.problem.at(vertices)
            if not point.nondegenerate:
                return None
            residual = point.residual - level
            error = base.problem.constraints.error(point.curve.mesh, residual)
            if error <= self.tolerance and corrections:
                return point
            if not error <= self.contraction * last:
                return None
            last = error
            correction = space.restoration(base.problem.constraints, point.curve, residual)
            change = np.linalg.norm(point.curve.mesh.changes(correction), axis=1)  # how it turns or stretches edges
            if np.max(change / point.curve.edge_lengths) > self.small:
                correction = -space.pseudo_inverse(residual)
            vertices = vertices + correction
        return None

    def transport(self, point: Point, u: FloatArray) -> FloatArray:
        return point.tangent_space.project(u)


class StepRule(Protocol):
    """How a method gets from point to point."""

    @property
    def second_order(self) -> bool:
        """Whether it needs the energy's second derivative."""

    @property
    def other_metrics(self) -> tuple[Metric, ...]:
        """Metrics that it needs besides the one that gradients are taken in."""

    def step(self, point: Point, state: SearchState) -> tuple[Step | NoStep, SearchState]:
        """Take one step, whose legs are proved as far as they can be."""


@dataclass(frozen=True)
class Method:
    """A descent method."""

    # name, description: name in the registry, and one line for those who know the mathematics
    name: str
    description: str
    rule: StepRule = field(repr=False)  # how steps are found
    metric: Metric = field(default=METRICS["moebius"], repr=False)  # the inner product that gradients are taken in
    geometry: Geometry = field(default=Constrained(), repr=False)  # whether lengths are prescribed or penalised
    label: str = ""  # what people call it, as a title; its name if nothing else is given
    comparison: bool = False  # whether it is there to be compared with, rather than to be used

    def __post_init__(self) -> None:
        object.__setattr__(self, "label", self.label or self.name)

    @property
    def sentence(self) -> str:
        return self.description if self.label == self.name else f"{self.label}: {self.description}"


def _all() -> Iterator[Method]:
    armijo, steepest, metric = Armijo(), SteepestDescent(), METRICS["moebius"]
    quasi_newton = Armijo(decrease=0.25)  # full steps gain half of what their slope promises, or a little less
    text = (
        f"L-BFGS on the constraint manifold with {_GRADIENTS}, metric J_C, made anew every third step; Armijo's rule "
        "with ¼; Newton's steps at the end"
    )
    # with more steps on one metric, more steps take back what is saved; conjugacy bears no change
    yield Method("lbfgs", text, LineSearch(LimitedMemoryBFGS(), quasi_newton, 3), label="Sobolev L-BFGS")
    text = f"conjugate gradients (PR+) on the constraint manifold with {_GRADIENTS}, metric J_C"
    yield Method("cg", text, LineSearch(ConjugateGradient(), armijo), label="Sobolev Conjugate Gradients")
    text = f"trust region in a subspace with Newton's direction, and {_GRADIENTS}, metric J_C"
    yield Method("trust-region", text, TrustRegion(), label="Sobolev Trust Region (Newton)")
    text = f"explicit flow along {_GRADIENTS}, metric {metric.description}"
    yield Method("flow-moebius", text, LineSearch(steepest, armijo), metric, label="Sobolev Gradient Flow")
    text = (
        "Section 6 of Sobolev Gradients for the Möbius Energy (2021) to the letter: J_C of the present curve, Armijo's "
        "rule with ½ from 2/3 of the collision step down, (42); no barrier, equal edges, one mesh, no strand moves"
    )
    # bounded by collisions, and by the curve's own length where there are none; with no kernel cut off; by (42) alone
    search = Armijo(first=FirstTrial(max_displacement=8.0, growth=1e9))
    whole, restoring = MoebiusMetric(least_distance=1e-9), Constrained(small=1e-300)
    label = "Gradient Flow of Reiter and Schumacher"
    yield Method("paper", text, LineSearch(steepest, search), whole, restoring, label=label)
    for name, metric in METRICS.items():
        if name != "moebius":
            text = f"projected gradient flow, explicit, {metric.description}"
            label = f"Explicit Flow in {metric.description}"
            yield Method(f"flow-{name}", text, LineSearch(steepest, armijo), metric, label=label, comparison=True)


METHODS: Mapping[str, Method] = Table(
    "mobius_flow.methods",
    lambda it: isinstance(it, Method),
    {method.name: method for method in _all()},
)
"""Every method that can be chosen, by name; those for comparison come last, with those that packages add."""
