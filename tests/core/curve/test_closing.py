"""Arcs closed far away: their knots are those that one sees."""

import numpy as np
import pytest
from mobius_flow.core import Curve, Mesh
from mobius_flow.core.collision import check_embedded
from mobius_flow.core.curve.refine import closed_far_away
from mobius_flow.core.knots import knot, knot_type


def test_an_overhand_knot_is_a_trefoil():
    closed = closed_far_away(knot("overhand", 60))
    assert closed.mesh.all_closed
    assert set(knot_type(closed).names) <= {"3_1", "m3_1"}


def test_what_is_closed_stays_and_arcs_do_not_meet_far_away():
    rng = np.random.default_rng(21)
    parts = [rng.normal(size=(6, 3)) for _ in range(4)] + [5 + np.eye(3)]
    closed = closed_far_away(Curve.from_components(parts, [False] * 4 + [True]))
    check_embedded(closed)
    assert np.array_equal(closed.components[-1], parts[-1])
    for part, before in zip(closed.components, parts, strict=True):
        assert np.array_equal(part[: len(before)], before)


@pytest.mark.parametrize("bent", [0.0, 0.1])
def test_straight_arcs_have_ends_that_are_opposite(bent):
    arc = Curve([[-1.0, 0, 0], [0, bent, 0], [1, 0, 0]], Mesh((3,), (False,)))
    assert knot_type(closed_far_away(arc)).names == ("0_1",)
