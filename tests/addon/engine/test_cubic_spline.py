"""Cubic splines against SciPy's."""

import numpy as np
import pytest
from mobius_flow.addon.engine.cubic_spline import basis, bezier_points, evaluated
from scipy.interpolate import BSpline

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
    spline = BSpline([0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 6, 6, 6], POINTS, 3)
    t = np.linspace(0, 1, 50)
    np.testing.assert_allclose(evaluated(bezier, t), spline(6 * t), atol=1e-12)


@pytest.mark.parametrize("closed", [True, False])
def test_the_basis_makes_the_same_points(closed):
    t = np.linspace(0, 1, 41)[: -1 if closed else None]
    np.testing.assert_allclose(basis(t, 9, closed) @ POINTS, evaluated(bezier_points(POINTS, closed), t), atol=1e-12)


def test_four_points_are_one_clamped_segment():
    np.testing.assert_allclose(bezier_points(POINTS[:4], closed=False), POINTS[None, :4], atol=1e-12)
