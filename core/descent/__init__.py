"""Descent methods: one file for each direction, one registry line for each method."""

from ..metrics.moebius import MoebiusMetric
from .flow import SteepestDescent
from .lbfgs import LimitedMemoryBFGS
from .method import Method, State
from .problem import Point, Problem
from .search import NoStep, Step

METHODS = {
    method.name: method
    for method in (
        Method("flow-moebius", "explicit projected gradient flow in the metric J_C", MoebiusMetric, SteepestDescent()),
        Method("lbfgs", "L-BFGS on the constraint manifold in the metric J_C", MoebiusMetric, LimitedMemoryBFGS()),
    )
}

__all__ = ["METHODS", "Method", "NoStep", "Point", "Problem", "State", "Step"]
