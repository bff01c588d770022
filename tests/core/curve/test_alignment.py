"""Alignments find similarities, starting points, directions and orders that were hidden on purpose."""

import numpy as np
import pytest
from mobius_flow.core import Curve, Mesh
from mobius_flow.core.collision import is_rope
from mobius_flow.core.curve.alignment import Alignment, Freedom, alignments
from mobius_flow.core.curve.measures import bending_radii
from mobius_flow.core.curve.refine import refined_alike, subdivide
from mobius_flow.core.knots import knot, smooth_knot
from scipy.spatial.transform import Rotation
from shapes import regular_polygon

TURN = Rotation.from_rotvec([0.3, -1.1, 2.0])
QUARTER = Rotation.from_euler("z", 90.0, degrees=True).as_matrix()


def hidden(curve, begin=17, backwards=False, order=None):
    """The same polygons elsewhere, in other sizes, from other starting points."""
    parts = [np.roll(part[::-1] if backwards else part, -begin, axis=0) for part in curve.components]
    parts = [parts[k] for k in (order or range(len(parts)))]
    return Curve.from_components([[5, 6, 7] + 0.2 * TURN.apply(part) for part in parts])


@pytest.mark.parametrize("backwards", [False, True])
@pytest.mark.parametrize("name", ["3_1", "8_17", "10_45"])
def test_a_knot_is_laid_upon_itself(name, backwards):
    curve = knot(name, 200)
    best = alignments(curve, hidden(curve, backwards=backwards), Freedom())[0]
    assert best.distance < 0.02
    there = best.moved(curve.vertices, 1.0)
    distances = np.linalg.norm(there[:, None] - hidden(curve).vertices, axis=2).min(axis=1)
    assert distances.max() < 0.02 * np.ptp(there, axis=0).max()


def test_halfway_sizes_and_angles_have_gone_half_their_way():
    square = np.array([[1.0, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]])
    grown = Alignment(QUARTER, 4.0, np.zeros(3), np.array([6.0, 0, 0]), (0,), (False,), (0.0,), 0.0, np.pi / 2)
    for share, size, angle in ((0.0, 1.0, 0.0), (0.5, 2.0, 45.0), (1.0, 4.0, 90.0)):
        there = [6.0 * share, 0, 0] + size * Rotation.from_euler("z", angle, degrees=True).apply(square)
        np.testing.assert_allclose(grown.moved(square, share), there, atol=1e-12)


def test_components_are_matched_in_all_orders():
    curve = knot("L6a5", 150)
    first, second, third = (subdivide(Curve(part), np.ones(len(part), dtype=int)) for part in curve.components)
    link = Curve.from_components([3.0 * first.vertices, second.vertices, 2.0 * third.vertices])
    best = alignments(link, hidden(link, order=(2, 0, 1)), Freedom())[0]
    assert best.distance < 0.02
    assert best.order == (1, 2, 0)


def test_no_reflection_is_an_alignment():
    curve = smooth_knot("3_1", 120)
    assert alignments(curve, curve.with_vertices(curve.vertices * [1, 1, -1]), Freedom())[0].distance > 0.3


def test_of_ways_that_fit_alike_one_keeps_order_directions_and_place():
    circle = knot("0_1", 60).vertices
    link = Curve.from_components([circle, np.add(circle, [0.0, 0.0, np.ptp(circle)])])
    best = alignments(link, link, Freedom())[0]
    assert best.as_given
    assert best.angle < 0.1


def test_a_common_mesh_has_the_vertices_of_both():
    x, y = knot("3_1", 61), knot("3_1", 90)
    fine, other = refined_alike(x, y, (0.37,))
    assert fine.mesh == other.mesh
    for curve, given in ((fine, x), (other, y)):
        assert {tuple(p) for p in given.vertices.tolist()} <= {tuple(p) for p in curve.vertices.tolist()}
        assert curve.length == pytest.approx(given.length, rel=1e-14)
    assert len(fine) <= len(x) + len(y)


@pytest.mark.parametrize("count", [41, 57, 90, 200])
def test_on_a_common_mesh_both_are_ropes_as_their_own_corners_allow(count):
    x, y = regular_polygon(40), regular_polygon(count)
    radius = np.array([0.9 * min(bending_radii(each).min() for each in (x, y))])
    for curve in refined_alike(x, y, (0.37,)):
        assert is_rope(curve.mesh, curve.vertices, curve.vertices, radius)


def test_about_an_axis_ends_stay():
    arc = Curve(np.random.default_rng(3).normal(size=(9, 3)), Mesh((9,), (False,)))
    start, end = arc.vertices[[0, -1]]
    axis = (end - start) / np.linalg.norm(end - start)
    turned = arc.with_vertices(start + Rotation.from_rotvec(1.3 * axis).apply(arc.vertices - start))
    best = alignments(arc, turned, Freedom(axis=axis, fixed=start))[0]
    assert best.distance < 1e-6
    assert np.allclose(best.moved(arc.vertices, 1.0), turned.vertices)
