"""Every way to take a step, and a point from which all of them have something to do."""

from functools import cache

import numpy as np
from descent_contracts import point_on, with_geometry
from mobius_flow.core.collision import Contact, FreeMotion
from mobius_flow.core.descent import Point, Problem
from mobius_flow.core.descent.directions import ConjugateGradient, LimitedMemoryBFGS, SteepestDescent
from mobius_flow.core.descent.geometry import Geometry
from mobius_flow.core.descent.line_searches import Armijo
from mobius_flow.core.descent.methods import StepRule
from mobius_flow.core.descent.second_order import TrustRegion
from mobius_flow.lab.methods import Accelerated, BackwardEuler, Penalised, WeakWolfe
from shapes import torus_trefoil

GEOMETRIES: dict[str, Geometry] = {"constrained": Geometry(), "penalised": Penalised(50.0)}
SEARCHES = {"armijo": Armijo(), "wolfe": WeakWolfe()}
DIRECTIONS = {"steepest": SteepestDescent(), "cg": ConjugateGradient(), "lbfgs": LimitedMemoryBFGS()}
RULES: dict[str, tuple[StepRule, str]] = {
    "trust region": (TrustRegion(), "constrained"),
    "backward Euler": (BackwardEuler(), "constrained"),
    "accelerated": (Accelerated(), "penalised"),
    "accelerated, constrained": (Accelerated(), "constrained"),
}


@cache
def start(geometry: str = "constrained") -> Point:
    """A trefoil that is far from its minimum."""
    rng = np.random.default_rng(31)
    curve = torus_trefoil(60)
    bent = curve.vertices * [1.0, 1.3, 1.1] + 0.02 * rng.normal(size=curve.vertices.shape)
    return with_geometry(point_on(curve.with_vertices(bent)), GEOMETRIES[geometry])


class Narrow(Problem):
    """A world in which vertices must not move by more than a given length at once."""

    width: float

    def free_motion(self, start: np.ndarray, end: np.ndarray, *, as_rope: bool = True) -> FreeMotion:
        way = float(np.abs(end - start).max()) / self.units.scale
        return FreeMotion(1.0) if way <= self.width else FreeMotion(self.width / way, Contact((0, 2)), proved=False)


def narrow(point: Point, width: float) -> Point:
    problem = Narrow(**{name: getattr(point.problem, name) for name in Problem.__dataclass_fields__})
    object.__setattr__(problem, "width", width)
    return point.within(problem)
