"""What objects show becomes obstacles of the world."""

import numpy as np
import pytest
from mobius_flow.addon.curves.surroundings import Surface, obstacles
from mobius_flow.core import CurveError
from mobius_flow.core.keys.placement import Placement

HERE = Placement(np.eye(3), np.zeros(3))
THERE = Placement(np.array([[2.0, 1.0, 0.0], [0.0, -1.0, 0.5], [0.0, 0.0, 3.0]]), np.array([5.0, 6.0, 7.0]))
SQUARE = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 2), (0, 0, 9)], dtype=np.float32)
TRIANGLES = np.array([(0, 1, 2), (2, 3, 0)], dtype=np.int32)
EDGES = np.array([(1, 0), (1, 2), (3, 2), (0, 3), (4, 3)], dtype=np.int32)


def surface(placement=HERE, triangles=TRIANGLES, edges=EDGES, points=SQUARE):
    return Surface.of_mesh(points, triangles, edges, placement)


def none(corners):
    return np.empty((0, corners), dtype=np.int32)


def test_edges_of_triangles_are_not_there_twice():
    np.testing.assert_array_equal(surface().edges, [(4, 3)])
    np.testing.assert_array_equal(surface(triangles=none(3)).edges, EDGES)
    assert len(surface(edges=none(2)).edges) == 0


def test_triangles_and_the_edges_of_none_are_two_obstacles_of_one_name():
    faces, lines = obstacles("Wall", [surface(THERE)])
    np.testing.assert_array_equal(faces.corners, THERE.to_world(SQUARE.astype(float))[TRIANGLES])
    np.testing.assert_array_equal(lines.corners, THERE.to_world(SQUARE.astype(float))[[(4, 3)]])
    assert faces.name == lines.name == "Wall"
    assert len(lines.vertices) == 2, "none that nothing uses: it could be anywhere"


def test_all_pieces_of_an_object_are_together():
    faces, lines = obstacles("Wall", [surface(), surface(edges=none(2)), surface(THERE, triangles=none(3))])
    assert faces.faces.shape == (4, 3)
    assert lines.faces.shape == (6, 2)
    np.testing.assert_array_equal(faces.corners[2:], SQUARE[TRIANGLES])
    np.testing.assert_array_equal(lines.corners[1:], THERE.to_world(SQUARE.astype(float))[EDGES])


@pytest.mark.parametrize("pieces", [[], [surface(triangles=none(3), edges=none(2))]], ids=["no piece", "points alone"])
def test_nothing_is_no_obstacle(pieces):
    with pytest.raises(CurveError, match="'Dust' shows neither faces nor edges"):
        list(obstacles("Dust", pieces))


@pytest.mark.parametrize("bad", [np.nan, np.inf, 3e38])
def test_what_is_not_finite_is_named(bad):
    points = SQUARE.copy()
    points[0, 1] = bad
    with pytest.raises(CurveError, match="A point of 'Wall' is not finite"):
        list(obstacles("Wall", [surface(points=points)]))
    points = SQUARE.copy()
    points[5, 1] = bad
    assert list(obstacles("Wall", [surface(points=points)])), "that point is no corner of anything"


def test_equal_pieces():
    assert surface(THERE).equals(surface(THERE))
    assert not surface(THERE).equals(surface(HERE))
    assert not surface().equals(surface(edges=none(2)))
