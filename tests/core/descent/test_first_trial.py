"""How far a search looks at first."""

import numpy as np
import pytest
from descent_cases import start
from descent_contracts import point_on, taken
from mobius_flow.core import Curve
from mobius_flow.core.descent import Point, SearchState, Step
from mobius_flow.core.descent.directions import SteepestDescent
from mobius_flow.core.descent.line_searches import Armijo, FirstTrial, LineSearch


def crossed_rods() -> Point:
    """Two thin triangles with a gap of 1 between edges that cross when seen from above."""
    lower = [[-2.0, 0, 0], [2, 0, 0], [0, 0, -3]]
    upper = [[0.0, -2, 1], [0, 2, 1], [0, 0.5, 4]]
    return point_on(Curve.from_components([lower, upper]))


def test_the_first_trial_is_two_thirds_of_the_first_contact() -> None:
    point = crossed_rods()
    down = (np.arange(6) >= 3)[:, None] * [0.0, 0.0, -1.0]
    contact = 1.0 / point.problem.units.scale
    tau, met = FirstTrial(max_displacement=100.0)(point, down, np.inf)
    assert tau == pytest.approx(2 / 3 * contact, rel=0.02)
    assert met is not None
    assert sorted(met.edges) == [0, 3]


def test_the_first_trial_is_bounded() -> None:
    point = crossed_rods()
    up = (np.arange(6) >= 3)[:, None] * [0.0, 0.0, 4.0]
    assert FirstTrial()(point, up, np.inf) == (0.5 / 4.0, None)
    assert FirstTrial()(point, up, 0.01) == (0.01, None)
    assert FirstTrial()(point, 0.0 * up, np.inf) == (0.0, None)


@pytest.mark.parametrize(("lengths", "bounded"), [("keep", True), ("equal", False)])
def test_step_sizes_recover_where_the_way_to_the_lengths_made_them_short(lengths: str, bounded: bool) -> None:
    point = point_on(start().curve, edge_lengths=lengths)
    step = Armijo().along(point, -point.gradient, np.inf, 1e-100)
    assert isinstance(step, Step) != bounded  # a motion of 10⁻¹⁰⁰ changes no coordinate
    if isinstance(step, Step):
        assert 1e-5 < np.abs(step.size * point.gradient).max() <= 1e-3


def test_steps_grow_by_a_bounded_factor() -> None:
    point = start()
    step, _ = taken(LineSearch(SteepestDescent(), Armijo()).step(point, SearchState(None, 1e-5)))
    assert step.size <= 4e-5
