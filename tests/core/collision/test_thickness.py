"""Thickness against values by hand and against brute force."""

import numpy as np
import pytest
from hard_curves import rope
from mobius_flow.core import Curve
from mobius_flow.core.collision.gap import bending_radii, thickness
from mobius_flow.core.knots import knot, smooth_knot


def slow_thickness(curve, count=20):
    """The same over all pairs of some points on each edge: too large by what lies between them."""
    bend = bending_radii(curve).min()
    t = np.arange(count) / count
    points = (curve.vertices[:, None] + t[:, None] * curve.edge_vectors[:, None]).reshape(-1, curve.dimension)
    along = (curve.arc_starts[:, None] + t * curve.edge_lengths[:, None]).ravel()
    component = np.repeat(curve.mesh.edge_component, count)
    lengths, best = curve.component_lengths[component], 2.0 * bend
    for point, place, part in zip(points, along, component, strict=True):
        apart = np.abs(along - place)
        far = (np.minimum(apart, lengths - apart) >= np.pi * bend) | (component != part)
        best = min(best, np.linalg.norm(points[far] - point, axis=1).min(initial=np.inf))
    return float(0.5 * best)


def stadium(cuts):
    """Two half circles of radius 1, joined by straight lines of length 10 that have vertices at some places."""
    angle = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 41)
    turn = np.column_stack([np.cos(angle), np.sin(angle), 0.0 * angle])
    across = np.array([[5.0 - cut, 1.0, 0.0] for cut in cuts])
    half = np.concatenate([turn + np.array([5.0, 0.0, 0.0]), across])
    return Curve(np.concatenate([half, half * [-1.0, -1.0, 1.0]]))


@pytest.mark.parametrize("count", [3, 4, 7, 200])
def test_regular_polygons_have_the_radius_of_their_inner_circle(count):
    angle = 2.0 * np.pi * np.arange(count) / count
    circle = Curve(5.0 * np.column_stack([np.cos(angle), np.sin(angle), 0.0 * angle]))
    assert thickness(circle) == pytest.approx(5.0 * np.cos(np.pi / count))
    assert np.allclose(bending_radii(circle), 5.0 * np.cos(np.pi / count))


def test_strands_side_by_side():
    curve = rope(2, 0.05, 120)
    assert thickness(curve) <= 0.025 + 1e-12
    hopf = knot("hopf", 200)
    assert thickness(hopf) == pytest.approx(slow_thickness(hopf), rel=1e-3)


@pytest.mark.parametrize("cuts", [(4.0,), (4.0, 4.3, 4.6), (0.2, 4.0, 4.1)])
def test_short_edges_beside_long_ones_on_a_straight_line(cuts):
    """Their distance is small because they are near along the curve, however far apart their tails are."""
    curve = stadium(cuts)
    assert thickness(curve) == pytest.approx(float(bending_radii(curve).min()))
    assert thickness(curve) == pytest.approx(slow_thickness(curve))


@pytest.mark.parametrize("name", ["3_1", "8_19", "L6a4"])
def test_brute_force_and_scale(name):
    curve = smooth_knot(name, 150)
    assert thickness(curve) == pytest.approx(slow_thickness(curve), rel=1e-3)
    assert thickness(curve.with_vertices(1e6 * curve.vertices)) == pytest.approx(1e6 * thickness(curve), rel=1e-9)


@pytest.mark.parametrize("share", [0.5, 0.999, 1.001, 2.0])
def test_only_what_is_less_is_looked_for(share):
    curve = knot("5_2", 120)
    whole = thickness(curve)
    assert thickness(curve, share * whole) == pytest.approx(min(share, 1.0) * whole, rel=1e-12)
