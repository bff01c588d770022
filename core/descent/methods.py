"""Descent methods: geometry × metric × the rule for steps, one registry line each."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Protocol

from ..metrics import METRICS, Metric
from .constrained import Constrained
from .directions import ConjugateGradient, LimitedMemoryBFGS, SteepestDescent
from .penalised import Penalised
from .problem import Geometry, Point
from .searches import Accelerated, Armijo, BackwardEuler, LineSearch, TrustRegion, WeakWolfe
from .state import State
from .step import NoStep, Step

_CONSTRAINED = Constrained()
METRIC_STEPS = 3  # of quasi-Newton methods: with more, more steps take back what is saved; conjugacy bears no change


class StepRule(Protocol):
    """How a method gets from point to point."""

    @property
    def second_order(self) -> bool:
        """Whether it needs the energy's second derivative."""

    @property
    def other_metrics(self) -> tuple[Metric, ...]:
        """Metrics that it needs besides the one that gradients are taken in."""

    def step(self, point: Point, state: State) -> tuple[Step | NoStep, State]:
        """Take one step, whose legs are proved as far as they can be."""


@dataclass(frozen=True)
class Method:
    """A descent method.

    Attributes
    ----------
    name, description
        Name in the registry, and one line for users.
    rule
        How steps are found.
    metric
        The inner product that gradients are taken in.
    geometry
        Whether lengths are prescribed or penalised.
    """

    name: str
    description: str
    rule: StepRule
    metric: Metric = METRICS["moebius"]
    geometry: Geometry = _CONSTRAINED


def _all() -> Iterator[Method]:
    armijo, wolfe, penalised = Armijo(), WeakWolfe(), Penalised()
    quasi_newton, conjugate, steepest = LimitedMemoryBFGS(), ConjugateGradient(), SteepestDescent()
    remembering = LimitedMemoryBFGS(history=30)
    text = "L-BFGS on the constraint manifold, metric J_C"
    yield Method("lbfgs", text, LineSearch(quasi_newton, armijo, METRIC_STEPS))
    text = "conjugate gradients (PR+) on the constraint manifold, metric J_C"
    yield Method("cg", text, LineSearch(conjugate, armijo))
    yield Method("trust-region", "trust region in a subspace with Newton's direction, metric J_C", TrustRegion())
    for name, metric in METRICS.items():
        text = f"projected gradient flow, explicit, {metric.description}"
        yield Method(f"flow-{name}", text, LineSearch(steepest, armijo), metric)
    for name, metric in METRICS.items():
        text = f"projected gradient flow, implicit, {metric.description}"
        yield Method(f"implicit-{name}", text, BackwardEuler(), metric)
    for name, text, rule in (
        ("lbfgs", "L-BFGS", LineSearch(remembering, wolfe, METRIC_STEPS)),
        ("cg", "conjugate gradients (PR+)", LineSearch(conjugate, wolfe)),
        ("nesterov", "Nesterov's accelerated gradient", Accelerated(wolfe)),
    ):
        yield Method(f"penalty-{name}", f"{text} on the penalised energy", rule, geometry=penalised)


METHODS: Mapping[str, Method] = MappingProxyType({method.name: method for method in _all()})
