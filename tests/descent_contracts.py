"""What steps promise, checked from outside, in the manner of scipy.optimize's assert_armijo."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
from mobius_flow.core import Curve
from mobius_flow.core.base.tolerances import ENERGY_ROUNDING
from mobius_flow.core.base.types import FloatArray
from mobius_flow.core.descent import Point, SearchState, Step
from mobius_flow.core.descent.geometry import Geometry
from mobius_flow.core.driver.prepare import start_problem
from mobius_flow.core.proof.filter import doubtful_pairs
from tasks import wanted


def point_on(curve: Curve, **options: object) -> Point:
    """A curve as a point of the problem that options make of it, its own lengths prescribed."""
    return start_problem(*wanted(curve, **{"vertices": len(curve), "edge_lengths": "keep", **options})).at_curve(curve)


def with_geometry(point: Point, geometry: Geometry) -> Point:
    """The same polygon where lengths are kept in another way."""
    return point.within(replace(point.problem, geometry=geometry))


def taken(result: object) -> tuple[Step, SearchState]:
    """The step that a rule has found."""
    assert isinstance(result, tuple)
    step, state = result
    assert isinstance(step, Step), step.reason
    return step, state


def assert_armijo(start: Point, step: Step, direction: FloatArray, decrease: float = 0.5) -> None:
    """E(Q) ≤ E(P) + c τ DE·d."""
    slope = step.size * float(np.sum(start.derivative * direction))
    assert slope < 0
    assert step.point.energy <= start.energy + decrease * slope + 10.0 * ENERGY_ROUNDING * abs(start.energy)


def assert_weak_wolfe(
    start: Point, step: Step, direction: FloatArray, decrease: float = 0.25, curvature: float = 0.9
) -> None:
    """E(Q) ≤ E(P) + c₁ τ DE(P)·d and DE(Q)·d ≥ c₂ DE(P)·d, d moved to Q."""
    assert_armijo(start, step, direction, decrease)
    slope = float(np.sum(start.derivative * direction))
    assert float(np.sum(step.point.derivative * step.point.transport(direction))) >= curvature * slope


def assert_certified(start: Point, step: Step) -> None:
    """Every leg has a proof, and code that shares nothing with it agrees."""
    assert step.certified
    corners = [start.placed, *(leg.end.placed for leg in step.legs)]
    for a, b in pairwise(corners):
        assert not list(doubtful_pairs(a, b, start.problem.mesh.heads))


def assert_feasible(step: Step, tolerance: float = 1e-10) -> None:
    """The end has the prescribed lengths and barycenter, where they are prescribed."""
    assert float(np.max(np.abs(step.point.residual))) <= tolerance
