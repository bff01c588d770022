"""How thick a tube may be."""

import numpy as np
import pytest
from mobius_flow.addon.engine.tube import free_radius, radius_beside, thickest_radius
from mobius_flow.core import Obstacle
from shapes import regular_polygon


def test_where_there_is_room_the_tube_is_as_thick_as_looks_right():
    circle = regular_polygon(100)
    thickest = thickest_radius(circle)
    assert free_radius(circle, thickest) == thickest


def floor(depth):
    """A square below a circle around the origin."""
    corners = np.array([(-9, -9, -depth), (9, -9, -depth), (9, 9, -depth), (-9, 9, -depth)])
    return Obstacle(corners, [(0, 1, 2), (0, 2, 3)])


@pytest.mark.parametrize("depth", [0.09, 0.03, 0.004])
def test_obstacles_leave_as_much_room_as_there_is(depth):
    radius = radius_beside(regular_polygon(100), 0.1, [floor(depth)])
    assert 0.97 * 0.94 * depth <= radius <= 0.94 * depth


def test_obstacles_far_away_and_none_leave_all_room():
    assert radius_beside(regular_polygon(100), 0.1, [floor(0.2)]) == 0.1
    assert radius_beside(regular_polygon(100), 0.1, []) == 0.1


def test_a_tube_can_always_be_drawn():
    assert radius_beside(regular_polygon(100), 0.1, [floor(1e-9)]) == pytest.approx(1e-4, rel=0.03)
