"""Bending times length, and the Möbius maps that change it."""

import numpy as np
import pytest
from mobius_flow.core import Curve, MoebiusEnergy
from mobius_flow.core.curve.measures import bending, bending_and_derivative
from mobius_flow.core.driver.moves.balance import moebius_image, moebius_pullback
from shapes import hopf_link, regular_polygon, torus_trefoil
from smooth_curves import SMOOTH_CURVES, random_polygon
from taylor import taylor_slope

QS = [(1.0, 0.0, 0.0, 0.0), (0.9, 0.1, -0.2, 0.3), (0.0, 0.0, 1.0, 0.0), (-0.5, 2.0, 0.1, 0.4)]


@pytest.mark.parametrize("n", [3, 7, 200])
def test_bending_of_regular_polygons(n):
    assert bending(regular_polygon(n)) == pytest.approx((2 * n * np.tan(np.pi / n)) ** 2, rel=1e-12)


def test_a_circle_bends_by_four_pi_squared():
    errors = [abs(bending(regular_polygon(n)) - 4 * np.pi**2) for n in (100, 200)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.1)
    assert errors[1] < 0.01


@pytest.mark.parametrize("seed", range(5))
def test_no_polygon_bends_less_than_a_circle(seed):
    assert bending(random_polygon(seed, (3 + seed,), 3)) > 4 * np.pi**2


def test_bending_does_not_see_size_or_place():
    curve = random_polygon(3, (9, 5), 3)
    moved = curve.with_vertices(1e3 * curve.vertices + 7.0)
    assert bending(moved) == pytest.approx(bending(curve), rel=1e-10)


@pytest.mark.parametrize("curve", [random_polygon(5, (12,), 3), random_polygon(7, (8, 5), 2), hopf_link(20)])
def test_derivative_of_bending(curve):
    value, derivative = bending_and_derivative(curve)
    u = np.random.default_rng(11).normal(size=curve.vertices.shape)
    slope = taylor_slope(
        lambda t: bending(curve.with_vertices(curve.vertices + t * u)), [value, np.sum(derivative * u)], 1e-2
    )
    assert slope == pytest.approx(2.0, abs=0.1)


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


@pytest.mark.parametrize("q", QS[1:])
def test_maps_are_rotations_of_the_sphere(q):
    points = np.random.default_rng(3).normal(size=(20, 3))
    np.testing.assert_allclose(moebius_image(points, np.array(q)), by_the_sphere(points, np.array(q)), rtol=1e-10)


@pytest.mark.parametrize("q", QS)
def test_multiples_of_q_are_the_same_map(q):
    points = np.random.default_rng(5).normal(size=(20, 3))
    image = moebius_image(points, np.array(q))
    np.testing.assert_allclose(moebius_image(points, -3.0 * np.array(q)), image, rtol=1e-10, atol=1e-12)


def test_the_identity():
    points = np.random.default_rng(7).normal(size=(5, 2))
    assert np.array_equal(moebius_image(points, np.array([2.0, 0.0, 0.0])), points)


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


def test_what_lies_on_the_pole_stays_finite():
    square = Curve([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
    assert np.isfinite(moebius_image(square.vertices, np.array([1.0, -1.0, 0.0]))).all()
