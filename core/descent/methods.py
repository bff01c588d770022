"""Descent methods: geometry × metric × the rule for steps, one registry line each."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Protocol

from ..base import Table
from ..solve.metrics import METRICS, Metric, MoebiusMetric
from .directions import ConjugateGradient, LimitedMemoryBFGS, SteepestDescent
from .geometry import Geometry
from .line_searches import Armijo, FirstTrial, LineSearch
from .problem import Point
from .second_order import TrustRegion
from .step import NoStep, SearchState, Step

_GRADIENTS = "projected fractional Sobolev gradients"


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
    geometry: Geometry = field(default=Geometry(), repr=False)  # whether lengths are prescribed or penalised
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
    whole, restoring = MoebiusMetric(least_distance=1e-9), Geometry(small=1e-300)
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
