"""The Taylor-remainder tool sees right and wrong derivatives."""

import math

import numpy as np
import pytest
from mobius_flow.core.energies import MoebiusEnergy
from smooth_curves import random_polygon
from taylor import derivative_slope, hessian_slope, taylor_slope


@pytest.mark.parametrize(
    ("terms", "slope"), [([1.0], 1), ([1.0] * 2, 2), ([1.0] * 4, 4), ([1.1], 0), ([1.0, 1.01], 1), ([1.0, 1.0, 1.1], 2)]
)
def test_the_slope_is_the_number_of_right_terms(terms, slope):
    assert taylor_slope(math.exp, terms, halvings=30) == pytest.approx(slope, abs=0.05)


def test_arrays_polynomials_and_energies():
    assert taylor_slope(lambda t: [math.sin(t), math.exp(t)], [[0, 1], [1, 1]]) == pytest.approx(2, abs=0.02)
    assert taylor_slope(lambda t: 2.0 + 3.0 * t, [2.0, 3.0]) == math.inf, "no remainder"
    curve = random_polygon(3, (12,), 3)
    v = np.random.default_rng(5).normal(size=curve.vertices.shape)
    assert derivative_slope(MoebiusEnergy(), curve, v, largest=1e-3) == pytest.approx(2, abs=0.01)
    assert hessian_slope(MoebiusEnergy(), curve, v, largest=1e-3) == pytest.approx(3, abs=0.01)
