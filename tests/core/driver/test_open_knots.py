"""Knots in open curves are told before they are lost, and after."""

import logging

import numpy as np
import pytest
from mobius_flow.core import Curve, Mesh, RelaxOptions, Task, minimize, relax
from mobius_flow.core.driver.moves.links import DIRECTIONS, open_knots
from mobius_flow.core.knots import knot, overhand

LOST = "component 1, which is open, was 3_1 if its ends are joined far away, and is not any more"


def test_types_of_open_components() -> None:
    arc, ring = overhand(60), knot("4_1", 60)
    apart = arc.vertices + np.array([100.0, 0.0, 0.0])
    both = Curve(np.vstack([ring.vertices, apart]), Mesh((60, 60), (True, False)))
    assert open_knots(both) == {1: "3_1"}
    mirrored = arc.with_vertices(arc.vertices * [1.0, 1.0, -1.0])
    assert open_knots(mirrored) == {0: "m3_1"}
    assert open_knots(Curve([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 1]], Mesh((4,), (False,)))) == {}
    assert open_knots(ring) == {}


def test_a_segment_towards_a_point_where_ends_are_joined_is_no_knot() -> None:
    for direction in DIRECTIONS:
        assert open_knots(Curve(np.linspace(0.0, 4.0, 9)[:, None] * direction, Mesh((9,), (False,)))) == {}


def test_a_knot_that_is_lost_is_told_before_and_after(caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.WARNING):
        result = minimize(overhand(60), RelaxOptions(vertices=60))
    assert "component 1 is open and knotted (3_1, if its ends are joined far away)" in caplog.text
    assert LOST in result.outcome.clauses
    assert abs(result.energies[-1]) < 1e-6


def test_a_knot_between_pinned_ends_is_not_announced(caplog: pytest.LogCaptureFixture) -> None:
    task = Task(curve=overhand(60), pins=(0, 59))
    with caplog.at_level(logging.WARNING):
        next(relax(task, RelaxOptions(vertices=60)))
        assert not caplog.records
        next(relax(Task(curve=overhand(60), pins=(0,)), RelaxOptions(vertices=60)))
    assert len(caplog.records) == 1
