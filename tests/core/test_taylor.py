"""The Taylor-remainder tool sees right and wrong derivatives."""

import math

import numpy as np
import pytest
from mobius_flow.core.base.errors import OptionError
from mobius_flow.core.energies import MoebiusEnergy
from smooth_curves import random_polygon
from taylor import derivative_slope, hessian_slope, taylor_slope


@pytest.mark.parametrize("terms", [1, 2, 3, 4])
def test_right_terms_give_their_number(terms: int) -> None:
    assert taylor_slope(math.exp, [1.0] * terms) == pytest.approx(terms, abs=0.02)


def test_array_values() -> None:
    assert taylor_slope(lambda t: [math.sin(t), math.exp(t)], [[0, 1], [1, 1]]) == pytest.approx(2, abs=0.02)


@pytest.mark.parametrize(("terms", "slope"), [([1.0, 1.01], 1), ([1.0, 1.0, 1.1], 2), ([1.1], 0)])
def test_a_wrong_term_lowers_the_slope(terms: list[float], slope: float) -> None:
    assert taylor_slope(math.exp, terms, halvings=30) == pytest.approx(slope, abs=0.05)


def test_a_polynomial_has_no_remainder() -> None:
    assert taylor_slope(lambda t: 2.0 + 3.0 * t, [2.0, 3.0]) == math.inf


def test_options_are_checked() -> None:
    with pytest.raises(OptionError, match="halvings"):
        taylor_slope(math.exp, [1.0], halvings=3)
    with pytest.raises(OptionError, match="largest"):
        taylor_slope(math.exp, [1.0], largest=0.0)


def test_energies() -> None:
    curve = random_polygon(3, (12,), 3)
    v = np.random.default_rng(5).normal(size=curve.vertices.shape)
    assert derivative_slope(MoebiusEnergy(), curve, v, largest=1e-3) == pytest.approx(2, abs=0.01)
    assert hessian_slope(MoebiusEnergy(), curve, v, largest=1e-3) == pytest.approx(3, abs=0.01)
