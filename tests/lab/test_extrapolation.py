"""The smooth curve's energy from three meshes: what is known of it lies within the error that is told."""

import math

import numpy as np
import pytest
from mobius_flow.core import Curve, RelaxOptions, minimize
from mobius_flow.core.knots import knot
from mobius_flow.lab.extrapolation import Extrapolation, extrapolated
from shapes import regular_polygon
from torus_energies import torus_knot_minimum


def of_series(*coefficients):
    """Of energies 1 + a h² + b h⁴ + …"""
    first, second, third = (
        1.0 + sum(c * h ** (2 * k) for k, c in enumerate(coefficients, 1)) for h in (1.0, 0.5, 0.25)
    )
    return Extrapolation((first, second, third))


def test_a_pure_second_order_error_is_taken_off():
    found = of_series(0.1)
    assert found.ratio == pytest.approx(4.0)
    assert found.order == pytest.approx(2.0)
    assert found.energy == pytest.approx(1.0, abs=1e-14)
    assert 0.0 < found.error < 2e-3 * 0.1


@pytest.mark.parametrize("fourth", [-0.05, -0.01, 0.003, 0.02, 0.1])
@pytest.mark.parametrize("sixth", [-0.01, 0.01])
def test_the_limit_is_within_the_error(fourth, sixth):
    found = of_series(0.1, fourth, sixth)
    assert abs(found.energy - 1.0) <= found.error


@pytest.mark.parametrize("energies", [(1.0, 1.1, 1.0), (1.2, 1.1, 1.0), (1.0, 1.0, 1.0), (1.0, 0.9, 0.9)])
def test_energies_of_no_order_have_a_large_error(energies):
    found = Extrapolation(energies)
    assert math.isfinite(found.energy)
    assert found.error == pytest.approx(float(np.abs(np.diff(energies)).sum()))


@pytest.mark.parametrize(
    ("name", "vertices", "smooth"),
    [("3_1", 90, torus_knot_minimum(2, 3)), ("5_1", 120, torus_knot_minimum(2, 5)), ("hopf", 80, 8.0 + 4.0 * np.pi**2)],
)
def test_known_energies_are_within_the_error(name, vertices, smooth):
    options = RelaxOptions(vertices=vertices)
    found = extrapolated(minimize(knot(name, vertices), options).curve, options)
    assert abs(found.energy - smooth) <= found.error < 2e-5 * smooth
    assert abs(found.energy - smooth) < 0.1 * abs(found.energies[2] - smooth)


def test_runs_that_do_not_converge_have_none():
    bent = regular_polygon(24).vertices * [1.0, 0.5, 1.0]
    assert extrapolated(Curve(bent), RelaxOptions(max_iterations=0)) is None
