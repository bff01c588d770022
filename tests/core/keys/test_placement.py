"""Places on a link become points of objects, in coordinates that go with these."""

import numpy as np
import pytest
from mobius_flow.core import Curve
from mobius_flow.core.base.errors import Place
from mobius_flow.core.keys.placement import Link, Placement, at, spots

TRIANGLE = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
LINK = Curve.from_components([TRIANGLE, TRIANGLE + 5, TRIANGLE + 9])
PLACEMENTS = (Placement(np.eye(3), np.zeros(3)), Placement(2 * np.eye(3), np.array([5.0, 5.0, 5.0])))
OBJECTS = Link(PLACEMENTS, (1, 2))


def test_vertices_of_one_object():
    (spot,) = spots(Place((4, 8), (6.0, 5.0, 5.0)), LINK, OBJECTS)
    assert spot.member == 1
    np.testing.assert_allclose(spot.points, [[0.5, 0, 0], [2, 2.5, 2]])
    np.testing.assert_allclose(spot.marks, [[0.5, 0, 0]])


def test_vertices_of_several_objects():
    first, second = spots(Place((4, 1, 5), (5.0, 5.0, 7.0)), LINK, OBJECTS)
    assert (first.member, second.member) == (1, 0)
    np.testing.assert_allclose(first.points, [[0.5, 0, 0], [0, 0.5, 0]])
    np.testing.assert_allclose(first.marks, [[0, 0, 1]])
    np.testing.assert_allclose(second.points, [[1, 0, 0]])
    assert second.marks.shape == (0, 3)


def test_a_place_without_vertices_is_at_the_nearest():
    (spot,) = spots(Place((), (0.9, 0.2, 0.0)), LINK, OBJECTS)
    assert spot.member == 0
    np.testing.assert_allclose(spot.points, [[1, 0, 0]])
    np.testing.assert_allclose(spot.marks, [[0.9, 0.2, 0]])


@pytest.mark.parametrize(
    ("wanted", "found"),
    [([[0.0, 0, 0]], [0, 3]), ([[0.9, 0, 0]], [1]), ([[0, 1.1, 0], [0.9, 0, 0]], [1, 2]), ([[0.0, 0, 0.1]], [0, 3])],
)
def test_nearest_points_and_those_in_the_same_place(wanted, found):
    points = np.vstack([TRIANGLE, TRIANGLE[:1]])
    assert np.flatnonzero(at(points, np.array(wanted, dtype=float))).tolist() == found
