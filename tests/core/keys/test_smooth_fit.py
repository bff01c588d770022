"""Smooth curves through polygons: how near they come, how fast, and what is proved of them."""

import numpy as np
import pytest
from mobius_flow.core import Curve, Mesh
from mobius_flow.core.keys.smooth_fit import SmoothFit, _basis, bezier_points, fitted
from mobius_flow.core.keys.tube import free_radius, thickest_radius
from scipy.interpolate import BSpline
from shapes import hopf_link, lattice_knot, regular_polygon, torus_trefoil


def circle_error(points):
    """Error of the spline of a circle, of so many vertices that the polygon's own error does not matter."""
    return fitted(regular_polygon(20_000), points).error


def test_errors_fall_with_the_fourth_power():
    errors = np.array([circle_error(points) for points in (8, 16, 32)])
    slopes = np.log2(errors[:-1] / errors[1:])
    assert (slopes > 3.9).all()


def brute_error(fit, samples=4000):
    """Distance between splines and polygon, each seen from the other, by many points."""
    t = np.arange(samples) / samples
    worst = 0.0
    for points, polygon in zip(fit.points, fit.curve.components, strict=True):
        bezier = bezier_points(points)
        k = (t * len(bezier)).astype(int)
        u = (t * len(bezier) - k)[:, None]
        a, b, c, d = (bezier[k, i] for i in range(4))
        spline = (1 - u) ** 3 * a + 3 * u * (1 - u) ** 2 * b + 3 * u**2 * (1 - u) * c + u**3 * d
        e = np.roll(polygon, -1, axis=0) - polygon
        s = (np.einsum("pni,ni->pn", spline[:, None] - polygon, e) / np.square(e).sum(axis=1)).clip(0, 1)
        to_polygon = np.linalg.norm(spline[:, None] - polygon - s[..., None] * e, axis=-1).min(axis=1)
        to_spline = np.linalg.norm(spline[:, None] - polygon, axis=-1).min(axis=0)
        worst = max(worst, to_polygon.max(), to_spline.max())
    return worst


@pytest.mark.parametrize("points", [8, 16, 40])
@pytest.mark.parametrize("curve", [torus_trefoil(120), hopf_link(60)], ids=["trefoil", "link"])
def test_the_error_is_no_less_than_the_distance(curve, points):
    fit = fitted(curve, points)
    distance = brute_error(fit)
    assert 0.9 * distance <= fit.error
    assert fit.error <= 3 * distance


def test_as_few_points_as_are_close():
    for curve in (regular_polygon(100), torus_trefoil(100), torus_trefoil(800)):
        fit = fitted(curve)
        assert fit.proved
        assert fit.error <= 0.05 * free_radius(curve, thickest_radius(curve))
        assert fitted(curve, len(fit.points[0]) // 2).error > fit.error
        assert len(fit.points[0]) <= 40


def test_a_spline_that_cuts_through_strands_is_not_proved():
    """Four points for a trefoil are an unknot."""
    fit = fitted(torus_trefoil(120), 4)
    assert not fit.proved
    assert fit.gap < 2 * fit.error
    assert fitted(torus_trefoil(120)).gap == np.inf


def test_nor_is_one_that_is_moved_through_another_component():
    fit = fitted(hopf_link(60), 12)
    assert fit.proved
    apart = SmoothFit(fit.curve, (fit.points[0], fit.points[1] + np.array([9.0, 0.0, 0.0])))
    assert not apart.proved


def test_unequal_edges_and_corners_leave_no_point_anywhere():
    curve = lattice_knot("3_1")
    for points in (8, 29, 60):
        fit = fitted(curve, points)
        assert np.abs(fit.points[0] - curve.vertices.mean(axis=0)).max() < 2 * np.ptp(curve.vertices)
    assert fitted(curve, 60).error < fitted(curve, 8).error


def test_the_place_does_not_matter():
    curve = torus_trefoil(100)
    moved = Curve(curve.vertices + 1000.0)
    assert fitted(moved, 24).error == pytest.approx(fitted(curve, 24).error, rel=1e-6)


def half_circle(n):
    angles = np.linspace(0, np.pi, n)
    return Curve(np.column_stack([np.cos(angles), np.sin(angles), 0 * angles]), Mesh((n,), (False,)))


def test_errors_along_an_arc_fall_with_the_fourth_power():
    errors = np.array([fitted(half_circle(20_000), points).error for points in (8, 14, 26)])
    slopes = np.log(errors[:-1] / errors[1:]) / np.log([11 / 5, 23 / 11])  # three segments less than points
    assert (slopes > 3.8).all()


def test_the_spline_of_an_arc_runs_from_end_to_end():
    arc = Curve(torus_trefoil(200).vertices[:180], Mesh((180,), (False,)))
    fit = fitted(arc)
    assert fit.proved
    assert fit.error <= 0.05 * free_radius(arc, thickest_radius(arc))
    np.testing.assert_array_equal(fit.points[0][[0, -1]], arc.vertices[[0, -1]])
    np.testing.assert_allclose(
        bezier_points(fit.points[0], closed=False)[[0, -1], [0, 3]], arc.vertices[[0, -1]], atol=1e-12
    )


def test_a_segment_is_its_own_spline():
    segment = Curve(np.array([[0.0, 1.0, 2.0], [3.0, -1.0, 2.0]]), Mesh((2,), (False,)))
    assert fitted(segment).error < 1e-12


def test_an_arc_beside_a_ring():
    ring = regular_polygon(100).vertices
    link = Curve.from_components([ring, half_circle(50).vertices + 3], (True, False))
    fit = fitted(link)
    assert fit.proved
    bezier = map(bezier_points, fit.points, (True, False))
    assert list(map(len, bezier)) == [len(fit.points[0]), len(fit.points[1]) - 3]


POINTS = np.random.default_rng(3).normal(size=(9, 3))


def test_bezier_points_are_those_of_the_b_spline():
    spline = BSpline(np.arange(-3, 13), np.concatenate([POINTS, POINTS[:3]]), 3)
    bezier = bezier_points(np.roll(POINTS, -1, axis=0))
    for k, segment in enumerate(bezier):
        np.testing.assert_allclose(segment[0], spline(k), atol=1e-12)
        np.testing.assert_allclose(segment[-1], spline(k + 1 if k < 8 else 0), atol=1e-12)
        np.testing.assert_allclose(3 * (segment[1] - segment[0]), spline(k, 1), atol=1e-12)


def test_a_clamped_spline_runs_from_its_first_point_to_its_last():
    bezier = bezier_points(POINTS, closed=False)
    assert bezier.shape == (6, 4, 3)
    np.testing.assert_allclose(bezier[[0, -1], [0, 3]], POINTS[[0, -1]], atol=1e-12)
    np.testing.assert_allclose(bezier[0, 1], POINTS[1], atol=1e-12)


@pytest.mark.parametrize("closed", [True, False])
def test_the_bezier_segments_are_the_spline(closed):
    bezier = bezier_points(POINTS, closed)
    u = np.linspace(0, 1, 9)[:-1]
    weights = np.stack([(1 - u) ** 3, 3 * u * (1 - u) ** 2, 3 * u**2 * (1 - u), u**3])
    t = (np.arange(len(bezier))[:, None] + u).ravel() / len(bezier)
    drawn = np.einsum("bu,sbi->sui", weights, bezier).reshape(-1, 3)
    np.testing.assert_allclose(_basis(t, len(POINTS), closed) @ POINTS, drawn, atol=1e-12)


def test_four_points_are_one_clamped_segment():
    np.testing.assert_allclose(bezier_points(POINTS[:4], closed=False), POINTS[None, :4], atol=1e-12)
