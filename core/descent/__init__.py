"""Descent methods: one file for each direction, one registry line for each method."""

from collections.abc import Mapping
from types import MappingProxyType

from ..metrics import METRICS, MoebiusMetric
from .cg import ConjugateGradient
from .flow import SteepestDescent
from .implicit import ImplicitFlow
from .lbfgs import LimitedMemoryBFGS
from .method import DEFAULT_PENALTY, LineSearchMethod, Method, State
from .nesterov import AcceleratedGradient
from .problem import Point, Problem
from .step import Leg, NoStep, Step
from .trust_region import TrustRegion

_J_C = MoebiusMetric()
_ALL: tuple[Method, ...] = (
    LineSearchMethod("lbfgs", "L-BFGS on the constraint manifold, metric J_C", _J_C, LimitedMemoryBFGS()),
    LineSearchMethod(
        "cg", "conjugate gradients (PR+) on the constraint manifold, metric J_C", _J_C, ConjugateGradient()
    ),
    TrustRegion("trust-region", "trust region in a subspace with Newton's direction, metric J_C", _J_C),
    *(
        LineSearchMethod(f"flow-{name}", f"projected gradient flow, explicit, {m.description}", m, SteepestDescent())
        for name, m in METRICS.items()
    ),
    *(
        ImplicitFlow(f"implicit-{name}", f"projected gradient flow, implicit, {m.description}", m)
        for name, m in METRICS.items()
    ),
    LineSearchMethod(
        "penalty-lbfgs", "L-BFGS on the penalised energy", _J_C, LimitedMemoryBFGS(history=30), DEFAULT_PENALTY
    ),
    LineSearchMethod(
        "penalty-cg", "conjugate gradients (PR+) on the penalised energy", _J_C, ConjugateGradient(), DEFAULT_PENALTY
    ),
    AcceleratedGradient(
        "penalty-nesterov", "Nesterov's accelerated gradient on the penalised energy", _J_C, DEFAULT_PENALTY
    ),
)

METHODS: Mapping[str, Method] = MappingProxyType({method.name: method for method in _ALL})

__all__ = ["METHODS", "Leg", "Method", "NoStep", "Point", "Problem", "State", "Step"]
