"""Balls enclose what doubles say, and lower bounds lie below what they bound, closely and between nodes too."""

import numpy as np
import pytest
from fourier_curves import CIRCLE, DUAL_CIRCLE, ELLIPSE, values
from mobius_flow.core import CurveError
from mobius_flow.core.knots.shapes import shapes

balls = pytest.importorskip("mobius_flow.core.smooth.balls")
TREFOIL = shapes()["3_1"].coefficients[0]


def doubles(matrix):
    return np.array([[complex(x) for x in row] for row in matrix.tolist()])


@pytest.mark.parametrize("order", [0, 1, 2])
@pytest.mark.parametrize("height", [0.0, 0.05, -0.02])
@pytest.mark.parametrize("shift", [0, 1])
def test_points_are_those_of_the_series(order, height, shift):
    t = (np.arange(9) + shift / 2) / 9 + 1j * height
    found = doubles(balls.Loop(TREFOIL).points(9, height, order, shift))
    np.testing.assert_allclose(found, values(TREFOIL, t, order), rtol=1e-11, atol=1e-11)


@pytest.mark.parametrize("order", [1, 2])
def test_majorants_are_above_the_derivatives(order):
    loop, t = balls.Loop(TREFOIL), np.arange(500) / 500
    for height in (0.0, 0.04):
        largest = np.linalg.norm(values(TREFOIL, t + 1j * height, order), axis=1).max()
        assert largest <= float(loop.majorant(order, height)) <= 5.0 * largest


def test_a_single_mode_reaches_its_majorant():
    for c in (CIRCLE, ELLIPSE):
        largest = np.linalg.norm(values(c, np.arange(64) / 64 + 0.1j, 2), axis=1).max()
        np.testing.assert_allclose(float(balls.Loop(c).majorant(2, 0.1)), largest, rtol=1e-14)


@pytest.mark.parametrize("second", [TREFOIL, DUAL_CIRCLE], ids=["itself", "another"])
@pytest.mark.parametrize("height", [0.0, 0.03])
def test_separations_by_doubles(second, height):
    first, n = balls.Loop(TREFOIL), 12
    other = first if second is TREFOIL else balls.Loop(second)
    s, t = np.arange(n) / n + 1j * height, (np.arange(n) + 0.5) / n
    expected = ((values(TREFOIL, s)[:, None] - values(second, t)) ** 2).sum(axis=2)
    if second is TREFOIL:
        expected = expected / np.sin(np.pi * (s[:, None] - t)) ** 2
    found = [[float(x) for x in row] for row in balls.separations(first, other, height, n)]
    np.testing.assert_allclose(found, expected.real, rtol=1e-9, atol=1e-9)


def cosine(least, x):
    """1 + least − cos 2π(s − x), whose least value is at x, as rows of one number."""
    return lambda n: ([balls.arb(1 + least) - (2 * (balls.arb(j) / n - x)).cos_pi()] for j in range(n))


def bump(least, x, y):
    """2 + least − cos 2π(s − x) − cos 2π(t − y) at shifted nodes for t, as separations have."""

    def rows(n):
        along = [(2 * (balls.arb(j) / n - x)).cos_pi() for j in range(n)]
        across = [(2 * ((balls.arb(k) + 0.5) / n - y)).cos_pi() for k in range(n)]
        return ([2 + least - u - v for v in across] for u in along)

    return rows


@pytest.mark.parametrize("least", [0.5, 0.05, 0.003])
@pytest.mark.parametrize("x", [0.0, 0.11, 0.125, 0.37])
def test_lower_bounds_hold_between_nodes(least, x):
    for sample in (cosine(least, x), bump(least, x, 0.3)):
        assert 0.2 * least < float(balls.floor(sample, 1)) <= least + 1e-12


def test_no_lower_bound_of_what_is_not_positive():
    assert balls.floor(cosine(0.0, 0.11), 1) is None
    assert balls.floor(cosine(-0.1, 0.0), 1) is None
    assert balls.floor(cosine(float("nan"), 0.0), 1) is None


@pytest.mark.parametrize("c", [CIRCLE[:, :2], CIRCLE[0], np.empty((0, 3)), CIRCLE * np.nan])
def test_coefficients_of_no_curve(c):
    with pytest.raises(CurveError, match="must be finite, of shape"):
        balls.Loop(c)
