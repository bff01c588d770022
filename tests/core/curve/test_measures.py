"""What is measured of curves: bending, and Möbius maps that change it; writhe and crossings; the nearest strands."""

import numpy as np
import pytest
from mobius_flow.core import Curve, CurveError, Mesh
from mobius_flow.core.curve import refine
from mobius_flow.core.curve.distances import arc_distance_of_vertices, nearest_strands
from mobius_flow.core.curve.measures import bending, bending_and_derivative, writhe_and_crossings
from mobius_flow.core.driver.moves.balance import moebius_image, moebius_pullback
from mobius_flow.core.knots import knot, overhand, smooth_knot
from mobius_flow.core.knots.diagrams import views
from shapes import hopf_link, regular_polygon, torus_trefoil
from smooth_curves import random_polygon
from taylor import taylor_slope

QS = [(1.0, 0.0, 0.0, 0.0), (0.9, 0.1, -0.2, 0.3), (0.0, 0.0, 1.0, 0.0), (-0.5, 2.0, 0.1, 0.4)]


@pytest.mark.parametrize("n", [3, 7, 200])
def test_no_polygon_bends_less_than_a_circle(n):
    """Whose bending regular polygons approach from above; derivatives and invariance are in `test_contract`."""
    assert bending(regular_polygon(n)) == pytest.approx((2 * n * np.tan(np.pi / n)) ** 2, rel=1e-12)
    assert bending(random_polygon(n, (n,), 3)) > 4 * np.pi**2


def by_the_sphere(points, q):
    """The map as it is defined: to the sphere, turned in one plane, and back."""
    m = points.shape[1]
    square = np.square(points).sum(axis=1, keepdims=True)
    sphere = np.hstack([2 * points, square - 1]) / (square + 1)
    half = np.arctan2(np.linalg.norm(q[1:]), q[0])
    axis = np.append(q[1:] / np.linalg.norm(q[1:]), 0.0)
    north = np.eye(m + 1)[m]
    a, h = sphere @ axis, sphere @ north
    turned_a, turned_h = np.cos(2 * half) * a + np.sin(2 * half) * h, -np.sin(2 * half) * a + np.cos(2 * half) * h
    sphere = sphere + np.outer(turned_a - a, axis) + np.outer(turned_h - h, north)
    return sphere[:, :m] / (1 - sphere[:, m:])


@pytest.mark.parametrize("q", QS)
def test_maps_are_rotations_of_the_sphere(q):
    """Multiples of q are the same one, and what lies on the pole stays finite."""
    points = np.random.default_rng(3).normal(size=(20, 3))
    image = moebius_image(points, np.array(q))
    expected = by_the_sphere(points, np.array(q)) if any(q[1:]) else points
    np.testing.assert_allclose(image, expected, rtol=1e-10)
    np.testing.assert_allclose(moebius_image(points, -3.0 * np.array(q)), image, rtol=1e-10, atol=1e-12)
    square = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
    assert np.isfinite(moebius_image(square, np.array([1.0, -1.0, 0.0]))).all()


@pytest.mark.parametrize("q", QS)
def test_derivative_by_the_map(q):
    curve, q = torus_trefoil(30), np.array(q)

    def along(t):
        return bending(curve.with_vertices(moebius_image(curve.vertices, q + t * u)))

    value, derivative = bending_and_derivative(curve.with_vertices(moebius_image(curve.vertices, q)))
    u = np.random.default_rng(13).normal(size=4)
    terms = [value, moebius_pullback(curve.vertices, q, derivative) @ u]
    assert taylor_slope(along, terms, 1e-2) == pytest.approx(2.0, abs=0.1)


def test_linked_squares_by_hand():
    """Two flat components cross, seen from anywhere, as often as signs make twice the linking number, or more."""
    square = np.array([[1.0, 1, 0], [-1, 1, 0], [-1, -1, 0], [1, -1, 0]])
    linked = Curve.from_components([square, square[:, [0, 2, 1]] + [1.0, 0, 0]])
    writhe, crossings = writhe_and_crossings(linked)
    assert abs(writhe) == pytest.approx(2.0, abs=1e-12)
    assert crossings > 2.0
    with pytest.raises(CurveError, match="dimension 2"):
        writhe_and_crossings(Curve(square[:, :2]))
    assert np.allclose(writhe_and_crossings(Curve(square)), 0.0, atol=1e-12)


@pytest.mark.parametrize("name", ["3_1", "5_2", "4_1"])
def test_mirror_images_and_directions(name):
    curve = smooth_knot(name, 150)
    writhe, crossings = writhe_and_crossings(curve)
    mirrored = curve.with_vertices(curve.vertices * [1.0, 1.0, -1.0])
    assert writhe_and_crossings(mirrored) == pytest.approx((-writhe, crossings), abs=1e-12)
    assert writhe_and_crossings(Curve(curve.vertices[::-1] * 7.0 + 3.0)) == pytest.approx(
        (writhe, crossings), abs=1e-10
    )


def test_both_are_means_over_views():
    curve = smooth_knot("5_2", 60)
    seen = np.array([(view.writhe, view.crossings) for view in list(views(curve, 600))[1:]])
    error = 4.0 * seen.std(axis=0) / np.sqrt(len(seen))
    assert (np.abs(seen.mean(axis=0) - writhe_and_crossings(curve)) < error).all()


def test_the_arcs_without_one_edge_have_all_pairs_of_edges_but_those_with_it():
    curve = smooth_knot("5_2", 40)
    arcs = [Curve(np.roll(curve.vertices, k, axis=0), Mesh((40,), (False,))) for k in range(40)]
    total = np.sum([writhe_and_crossings(arc) for arc in arcs], axis=0)
    np.testing.assert_allclose(total, 38 * np.array(writhe_and_crossings(curve)), rtol=1e-12)


RATIO = 3.0


def of_all_pairs(curve, furthest=np.inf):
    i, j = np.triu_indices(len(curve), 1)
    distance = np.linalg.norm(curve.vertices[i] - curve.vertices[j], axis=1)
    chosen = (arc_distance_of_vertices(curve, i, j) > RATIO * distance) & (distance <= furthest)
    return float(distance[chosen].min(initial=np.inf))


@pytest.mark.parametrize("name", ["3_1", "8_19", "T(7,8)", "L6a4", "overhand"])
def test_they_are_those_of_all_pairs(name):
    curve = knot(name)
    for furthest in (0.01 * curve.length, 0.1 * curve.length, np.inf):
        assert nearest_strands(curve, RATIO, furthest) == of_all_pairs(curve, furthest)


def test_unequal_edges_do_not_matter():
    link = hopf_link(30)
    curve = Curve.from_components([refine(Curve(link.components[0]), 500).vertices, link.components[1][::3]])
    assert nearest_strands(curve, RATIO) == of_all_pairs(curve)


def test_circles_vertices_that_coincide_and_arcs():
    """A circle has no other strand, most edges may have no length, and arcs have a vertex more than edges."""
    assert nearest_strands(regular_polygon(100), RATIO) == np.inf
    doubled = np.repeat(np.array([[0.0, 0.0, 0.0], [9.0, 0.0, 0.0], [9.0, 9.0, 0.0], [0.0, 9.0, 0.0]]), 3, axis=0)
    curve = Curve.from_components([doubled, doubled + np.array([0.0, 0.0, 1.0])])
    assert nearest_strands(curve, RATIO) == 1.0
    link = Curve.from_components([hopf_link(30).components[0] + 2.0, overhand(90).vertices], (True, False))
    assert nearest_strands(link, RATIO) == of_all_pairs(link)
