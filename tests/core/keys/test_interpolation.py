"""Values and shapes between vertices and keys, and smooth splines that fit."""

import numpy as np
import pytest
from mobius_flow.core import Curve, Mesh
from mobius_flow.core.curve import interpolated, refine
from mobius_flow.core.curve.tube import places_between, rings, tangents
from mobius_flow.core.keys.markers import along, on_refined
from mobius_flow.core.keys.smooth_fit import SmoothFit, _basis, bezier_points, fitted
from mobius_flow.core.keys.tube import free_radius, thickest_radius
from mobius_flow.core.knots import overhand
from scipy.interpolate import BSpline
from shapes import hopf_link, regular_polygon, torus_trefoil


@pytest.mark.parametrize("curve", [torus_trefoil(20), hopf_link(12), overhand(40)], ids=["knot", "link", "arc"])
@pytest.mark.parametrize("vertices", [77, 133])
def test_coordinates_of_refined_vertices_lie_between_those_of_corners(curve, vertices):
    refined = refine(curve, vertices)
    for k, closed in enumerate(curve.mesh.closed):
        lengths, finer = (each.edge_lengths[each.mesh.edge_slices[k]] for each in (curve, refined))
        for old, new in zip(curve.components[k].T, refined.components[k].T, strict=True):
            np.testing.assert_allclose(on_refined(old, lengths, finer, closed), new, atol=1e-12)
            np.testing.assert_array_equal(on_refined(old, lengths, lengths, closed), old)  # where it was fine enough


def test_values_lie_evenly_along_what_is_drawn_and_shapes_between_keys_are_straight():
    values = np.array([1.0, 2.0, 4.0], dtype=np.float32)
    np.testing.assert_allclose(along(values, 6, closed=True), [1, 1.5, 2, 3, 4, 2.5])
    np.testing.assert_allclose(along(values, 5, closed=False), [1, 1.5, 2, 3, 4])
    values = np.array([[0.0, 1.0], [2.0, 1.0], [2.0, 5.0]])
    np.testing.assert_allclose(
        interpolated(values, np.array([0.25, 1.0, 1.5, 2.0])), [[0.5, 1], [2, 1], [2, 3], [2, 5]]
    )
    np.testing.assert_array_equal(interpolated(values[:1], np.zeros(1)), values[:1])
    zeros = np.array([-0.0, 1.0, -0.0])  # values that are hit stay bit for bit
    assert interpolated(zeros, np.array([0.0, 1.0])).tobytes() == zeros[:2].tobytes()


def turning(angle, n=60):
    """A circle that moves to the same one turned about an axis in its plane."""
    start = regular_polygon(n).vertices + np.array([0.0, 0.0, 2.0])
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([start, start @ np.array([[1, 0, 0], [0, c, -s], [0, s, c]]).T])


def thinnest(points, radius=0.1, sides=8):
    """Least distance of the tube's vertices from the curve, at the keys and halfway between them."""
    mesh = Mesh((points.shape[1],))
    shapes = rings(points, np.full(points.shape[:2], radius), mesh, sides).reshape(len(points), -1, sides, 3)
    shapes, middles = (interpolated(x, np.arange(0, len(points) - 0.75, 0.5)) for x in (shapes, points))
    return np.linalg.norm(shapes - middles[:, :, None], axis=-1).min()


@pytest.mark.parametrize("degrees", [40, 90, 140])
def test_the_tube_stays_thick(degrees):
    points = turning(np.radians(degrees))
    places = places_between(points, Mesh((60,)))
    finer = interpolated(points, places)
    cosines = np.einsum("kni,kni->kn", *(tangents(x) for x in (finer[:-1], finer[1:])))
    assert cosines.min() >= np.cos(np.radians(30)) - 1e-12
    assert thinnest(finer) > 0.096
    assert thinnest(points) < thinnest(finer)


def test_keys_stay_and_small_turns_need_no_more():
    points = np.stack([torus_trefoil(50).vertices * scale for scale in (1.0, 1.1, 1.2)])
    np.testing.assert_array_equal(places_between(points, Mesh((50,))), [0, 1, 2])
    places = places_between(np.concatenate([turning(0.1), turning(2.0)[1:]]), Mesh((60,)))
    assert {0.0, 1.0, 2.0} < set(places)
    assert not ((places > 0) & (places < 1)).any()
    inside_out = turning(np.pi)
    assert 3 < len(places_between(inside_out, Mesh((60,)))) <= 33
    np.testing.assert_array_equal(places_between(inside_out[:1], Mesh((60,))), [0.0])


POINTS = np.random.default_rng(3).normal(size=(9, 3))


@pytest.mark.parametrize("closed", [True, False])
def test_bezier_segments_and_the_basis_are_the_b_spline(closed):
    if closed:  # the first segment's control points begin with the last one
        spline = BSpline(np.arange(-3, 13), np.concatenate([POINTS[-1:], POINTS, POINTS[:2]]), 3)
    else:
        spline = BSpline(np.pad(np.arange(7), 3, mode="edge"), POINTS, 3)
    place, handle = bezier_points(POINTS, closed)
    bezier = np.stack([place, place + handle, np.roll(place - handle, -1, axis=0), np.roll(place, -1, axis=0)], axis=1)
    bezier = bezier[: 9 if closed else 6]  # of an arc the last joint is its end
    assert len(place) == (9 if closed else 7)
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
