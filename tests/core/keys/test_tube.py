"""How thick a tube may be."""

import numpy as np
import pytest
from mobius_flow.core import Curve, Obstacle
from mobius_flow.core.curve.distances import nearest_strands
from mobius_flow.core.keys.tube import free_radius, radius_beside, strand_gap, thickest_radius
from mobius_flow.core.knots import smooth_knot
from shapes import regular_polygon


@pytest.mark.parametrize("n", [150, 600])
def test_a_tube_is_thinner_where_the_curve_bends_on_its_scale(n):
    """Waves round a ring, whose bends have a radius of 0.08: the tube would be a row of lumps."""
    angles = np.linspace(0.0, 2.0 * np.pi, n, endpoint=False)
    away = 1.0 + 0.03 * np.cos(20 * angles)
    curve = Curve(np.stack([away * np.cos(angles), away * np.sin(angles), 0.0 * angles], axis=1))
    radius = free_radius(curve, thickest_radius(curve))
    assert 0.5 * thickest_radius(curve) <= radius < 0.8 * thickest_radius(curve)
    large = Curve(3.0 * curve.vertices)
    assert free_radius(large, thickest_radius(large)) == pytest.approx(3.0 * radius, rel=0.01)


def test_corners_make_no_tube_thinner():
    square = regular_polygon(4)
    assert free_radius(square, thickest_radius(square)) == thickest_radius(square)


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


@pytest.mark.parametrize("pieces", [2, 10, 100])
def test_strands_side_by_side_have_a_gap_however_long_their_edges_are(pieces):
    """Edges may be nearer to each other than their ends, but where these lie side by side they are not."""
    x = np.linspace(-1.0, 1.0, pieces + 1)
    strands = [np.stack([x, 0 * x, 0 * x + z], axis=1) for z in (0.0, 0.1)]
    gap = strand_gap(Curve.from_components(strands, (False, False)), 2.0)
    assert gap + 1e-12 >= 0.05
    assert gap <= 0.1


@pytest.mark.parametrize("name", ["3_1", "10_165", "L6a4"])
@pytest.mark.parametrize("flat", [1.0, 0.3, 0.02])
def test_some_of_the_vertices_tell_gaps_as_all_do(name, flat):
    knot = smooth_knot(name, 3000)
    knot = knot.with_vertices(knot.vertices * [1.0, 1.0, flat])
    widest = 2.0 * thickest_radius(knot)
    nearest = np.sqrt(nearest_strands(knot, 3.0, widest) ** 2 - 0.25 * knot.edge_lengths.max() ** 2)
    assert min(strand_gap(knot, widest), widest) == pytest.approx(min(nearest, widest), rel=0.01)


def test_open_ends_count_however_few_vertices_do():
    x = np.linspace(0.0, 1.0, 1999)
    strand = np.stack([x, 0 * x, 0 * x], axis=1)
    crossing = np.stack([1.0 + 0 * x, x - 0.5, 0 * x + 0.01], axis=1)
    gap = strand_gap(Curve.from_components([strand, crossing], (False, False)), 0.4)
    assert gap == pytest.approx(0.01, rel=0.01)
