"""Smooth curves through polygons: how near they come, how fast, and what is proved of them."""

import numpy as np
import pytest
from mobius_flow.core import Curve, Mesh
from mobius_flow.core.keys.smooth_fit import SmoothFit, _basis, bezier_points, fitted
from mobius_flow.core.keys.tube import free_radius, thickest_radius
from scipy.interpolate import BSpline
from shapes import hopf_link, regular_polygon, torus_trefoil

POINTS = np.random.default_rng(3).normal(size=(9, 3))


@pytest.mark.parametrize("closed", [True, False])
def test_bezier_segments_and_the_basis_are_the_b_spline(closed):
    if closed:  # the first segment's control points begin with the last one
        spline = BSpline(np.arange(-3, 13), np.concatenate([POINTS[-1:], POINTS, POINTS[:2]]), 3)
    else:
        spline = BSpline(np.pad(np.arange(7), 3, mode="edge"), POINTS, 3)
    bezier = bezier_points(POINTS, closed)
    assert len(bezier) == (9 if closed else 6)
    u = np.linspace(0, 1, 9)[:-1]
    weights = np.stack([(1 - u) ** 3, 3 * u * (1 - u) ** 2, 3 * u**2 * (1 - u), u**3])
    t = (np.arange(len(bezier))[:, None] + u).ravel()
    drawn = np.einsum("bu,sbi->sui", weights, bezier).reshape(-1, 3)
    np.testing.assert_allclose(drawn, spline(t), atol=1e-12)
    np.testing.assert_allclose(_basis(t / len(bezier), len(POINTS), closed) @ POINTS, drawn, atol=1e-12)


def half_circle(n):
    angles = np.linspace(0, np.pi, n)
    return Curve(np.column_stack([np.cos(angles), np.sin(angles), 0 * angles]), Mesh((n,), (False,)))


@pytest.mark.parametrize(("curve", "extra"), [(regular_polygon, 0), (half_circle, 3)])
def test_errors_fall_with_the_fourth_power(curve, extra):
    """An arc has three points more than segments; so fine a polygon's own error does not matter."""
    errors = np.array([fitted(curve(20_000), segments + extra).error for segments in (8, 16, 32)])
    assert (np.log2(errors[:-1] / errors[1:]) > 3.8).all()


@pytest.mark.parametrize("points", [8, 16, 40])
@pytest.mark.parametrize("curve", [torus_trefoil(120), hopf_link(60)], ids=["trefoil", "link"])
def test_the_error_is_no_less_than_the_distance(curve, points):
    fit, distance = fitted(curve, points), 0.0
    for control, polygon in zip(fit.points, curve.components, strict=True):
        spline = _basis(np.arange(4000) / 4000, points, True) @ control
        e, chord = np.roll(polygon, -1, axis=0) - polygon, spline[:, None] - polygon
        s = (np.einsum("pni,ni->pn", chord, e) / np.square(e).sum(axis=1)).clip(0, 1)
        to_polygon = np.linalg.norm(chord - s[..., None] * e, axis=-1).min(axis=1)
        distance = max(distance, to_polygon.max(), np.linalg.norm(chord, axis=-1).min(axis=0).max())
    assert 0.9 * distance <= fit.error <= 3 * distance


def test_as_few_points_as_are_close():
    for curve in (regular_polygon(100), torus_trefoil(100), torus_trefoil(800)):
        fit = fitted(curve)
        assert fit.proved
        assert fit.error <= 0.05 * free_radius(curve, thickest_radius(curve))
        assert fitted(curve, len(fit.points[0]) // 2).error > fit.error
        assert len(fit.points[0]) <= 40


def test_a_spline_that_cuts_through_strands_or_another_component_is_not_proved():
    """Four points for a trefoil are an unknot."""
    fit = fitted(torus_trefoil(120), 4)
    assert not fit.proved
    assert fit.gap < 2 * fit.error
    assert fitted(torus_trefoil(120)).gap == np.inf
    link = fitted(hopf_link(60), 12)
    assert link.proved
    assert not SmoothFit(link.curve, (link.points[0], link.points[1] + np.array([9.0, 0.0, 0.0]))).proved


def test_the_spline_of_an_arc_runs_from_end_to_end_also_beside_a_ring():
    arc = torus_trefoil(200).vertices[:180]
    ring = regular_polygon(100).vertices + 9.0
    fit = fitted(Curve.from_components([ring, arc], (True, False)))
    assert fit.proved
    assert fit.error <= 0.05 * free_radius(fit.curve, thickest_radius(fit.curve))
    np.testing.assert_array_equal(fit.points[1][[0, -1]], arc[[0, -1]])
    segment = Curve(np.array([[0.0, 1.0, 2.0], [3.0, -1.0, 2.0]]), Mesh((2,), (False,)))
    assert fitted(segment).error < 1e-12  # which is its own spline
