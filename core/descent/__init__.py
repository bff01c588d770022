"""Descent methods: one file for each direction, one registry line for each method."""

from collections.abc import Mapping
from types import MappingProxyType

from ..metrics import METRICS, MoebiusMetric
from .flow import SteepestDescent
from .lbfgs import LimitedMemoryBFGS
from .method import Method, State
from .problem import Point, Problem
from .search import NoStep, Step

_FLOWS = tuple(
    Method(
        f"flow-{name}",
        f"explicit projected gradient flow in the metric {metric.description}",
        metric,
        SteepestDescent(),
    )
    for name, metric in METRICS.items()
)

METHODS: Mapping[str, Method] = MappingProxyType(
    {
        method.name: method
        for method in (
            Method(
                "lbfgs", "L-BFGS on the constraint manifold in the metric J_C", MoebiusMetric(), LimitedMemoryBFGS()
            ),
            *_FLOWS,
        )
    }
)

__all__ = ["METHODS", "Method", "NoStep", "Point", "Problem", "State", "Step"]
