"""Bending times length, and the Möbius maps that change it."""

import numpy as np
import pytest
from mobius_flow.core import MoebiusEnergy
from mobius_flow.core.curve.measures import bending, bending_and_derivative
from mobius_flow.core.driver.moves.balance import moebius_image, moebius_pullback
from shapes import regular_polygon, torus_trefoil
from smooth_curves import SMOOTH_CURVES, random_polygon
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
def test_energy_is_that_of_the_image(q):
    """The midpoint sum is invariant up to its own error, which vanishes like 1/n."""
    energy = MoebiusEnergy()
    for n, allowed in ((400, 0.4), (1600, 0.1)):
        curve = SMOOTH_CURVES["trefoil-2"].polygon(n)
        vertices = curve.vertices / np.sqrt(np.square(curve.vertices).sum(axis=1).mean())
        image = curve.with_vertices(moebius_image(vertices, np.array(q) / np.linalg.norm(q)))
        assert abs(energy.value(image) - energy.value(curve)) < allowed


@pytest.mark.parametrize("q", QS)
def test_derivative_by_the_map(q):
    curve, q = torus_trefoil(30), np.array(q)

    def along(t):
        return bending(curve.with_vertices(moebius_image(curve.vertices, q + t * u)))

    value, derivative = bending_and_derivative(curve.with_vertices(moebius_image(curve.vertices, q)))
    u = np.random.default_rng(13).normal(size=4)
    terms = [value, moebius_pullback(curve.vertices, q, derivative) @ u]
    assert taylor_slope(along, terms, 1e-2) == pytest.approx(2.0, abs=0.1)
