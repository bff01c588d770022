"""Energies lie between their bounds, however far these are apart, and the integrand is bounded in its strip."""

import functools
import math

import numpy as np
import pytest
from fourier_curves import CIRCLE, CUSPS, DOUBLE_POINT, DUAL_CIRCLE, ELLIPSE, fitted, torus_knot, values
from hypothesis import example, given, settings
from hypothesis import strategies as st
from mobius_flow.core import CurveError, OptionError
from mobius_flow.core.knots.shapes import shapes
from mobius_flow.lab.smooth.energy import Basis, SampledPairs
from mobius_flow.lab.smooth.fourier import FourierCurve
from mobius_flow.lab.smooth.least import lower_bound
from smooth_curves import SMOOTH_CURVES
from torus_energies import torus_knot_energy

bounds = pytest.importorskip("mobius_flow.lab.smooth.bounds")
HOPF = [CIRCLE, DUAL_CIRCLE]


@pytest.mark.parametrize("name", SMOOTH_CURVES)
def test_curves_of_known_energies(name):
    curve = SMOOTH_CURVES[name]
    c = fitted(curve.polygon(32).vertices @ np.eye(curve.polygon(32).dimension, 3), 15)
    lower, upper = bounds.energy_bounds([c], 1e-9)
    assert lower - 2e-9 <= curve.energy <= upper + 2e-9  # known to nine decimals
    assert upper - lower < 2e-9


@pytest.mark.parametrize("name", ["5_2", "9_40", "L6a4", "L7a1"])
def test_another_formula_in_doubles(name):
    curve = FourierCurve(shapes()[name].coefficients)
    basis = Basis.of(curve.modes, 960 // sum(curve.modes))
    lower, upper = bounds.energy_bounds(curve.coefficients, 1e-6)
    assert lower - 1e-6 < SampledPairs.of(basis, basis.unknowns(curve)).energy < upper + 1e-6


@pytest.mark.parametrize("tolerance", [1e7, 1e3, 1.0, 1e-4, 1e-10])
def test_wide_bounds_are_right_too(tolerance):
    exact = 81.840852989
    c = fitted(SMOOTH_CURVES["trefoil"].polygon(32).vertices, 15)
    for curves, energy, slack in ([c], exact, 1e-9), ([CIRCLE], 4.0, 0.0), (HOPF, 8.0 + 4.0 * np.pi**2, 0.0):
        lower, upper = bounds.energy_bounds(curves, tolerance)
        assert lower - slack <= energy <= upper + slack
        assert upper - lower <= tolerance + 1e-9


def test_few_nodes_err_more_than_rounding():
    """Or else the bounds above would hold without any error term."""
    c = fitted(SMOOTH_CURVES["trefoil"].polygon(32).vertices, 15)
    lower, upper = bounds.energy_bounds([c], 1e7)
    assert abs(0.5 * (lower + upper) - 81.840852989) > 0.01


@pytest.mark.parametrize(("q", "a", "energy"), [(3, 0.8804855, 74.4120428860), (5, 0.93, None)])
def test_torus_knots_by_their_integrals(q, a, energy):
    """Of the minimum, where the energy is known, modes that are left out and the last digits of a hardly matter."""
    lower, upper = bounds.energy_bounds([fitted(torus_knot(2, q, a, 512), 60)])
    assert lower - 1e-7 <= (energy or torus_knot_energy(2, q, a)) <= upper + 1e-7
    assert lower_bound(f"{q}_1") < lower


def test_strands_far_nearer_than_the_curve_is_long():
    """An inversion keeps the energy, which is known, and draws all strands together that are far from its centre."""
    relative = torus_knot(2, 3, 0.8804855, 2048)
    relative -= relative[0] + np.array([0.0, 0.0, 0.3])
    c = fitted(relative / np.sum(relative**2, axis=1)[:, None], 160)
    lower, upper = bounds.energy_bounds([c], 1e-7)
    assert lower - 2e-8 <= 74.4120428860 <= upper + 2e-8


@pytest.mark.parametrize("curves", [[ELLIPSE], HOPF, shapes()["5_2"].coefficients, shapes()["L6a4"].coefficients])
def test_the_integrand_is_bounded_in_the_strip(curves):
    arcs = [bounds.CurveArcs.of(c) for c in curves]
    for i, j in {(0, 0), (0, len(arcs) - 1)}:
        strip = bounds._strip(arcs, i, j)
        s, t = np.arange(400) / 400, (np.arange(400) + 0.5) / 400
        for y in np.linspace(0.0, strip.height, 4):
            squares = (values(curves[i], s + 1j * y, 1) ** 2).sum(axis=1)
            chords = ((values(curves[i], s + 1j * y)[:, None] - values(curves[j], t)) ** 2).sum(axis=2)
            speeds = np.linalg.norm(values(curves[j], t, 1), axis=1)
            density = np.sqrt(squares)[:, None] * speeds / chords
            if i == j:
                density -= np.pi**2 / np.sin(np.pi * (s[:, None] + 1j * y - t)) ** 2
            assert np.abs(density).max() <= float(strip.bound)
            assert squares.real.min() > 0.0


@pytest.mark.parametrize("away", [0.0, 1e8])
def test_sums_in_doubles_are_those_of_many_digits(away):
    c, nodes, sides = shapes()["5_2"].coefficients[0].copy(), 60, []
    c[0, 0] = away
    with bounds.precise():
        for shift in (0, 1):
            x, v = (np.vectorize(bounds.arb)(bounds.points(c, nodes, order, shift)).sum(axis=0).T for order in (0, 1))
            sides.append((x, [sum(row**2).sqrt() for row in v]))
        (x, v), (y, w) = sides
        total = sum(v[k] * w[m] / sum((x[k] - y[m]) ** 2) for k in range(nodes) for m in range(nodes))
        found = bounds._mean(c, c, nodes)
        assert found.contains(total / nodes**2)
        assert float(found.rad() / found) < 2e-14


@pytest.mark.parametrize("nodes", [1, 2, 5, 12])
def test_the_error_of_the_trapezoidal_rule_for_a_pole(nodes):
    """For 1/(1 − r e^{2πis}), whose trapezoidal sums err by r^n/(1 − r^n)."""
    r, height = 0.1, 0.3
    strip = bounds._Strip(height, bounds.arb(1 / (1 - r * math.exp(2 * np.pi * height))))
    assert 2 * r**nodes / (1 - r**nodes) <= float(strip.error(nodes)) < 40 * 0.67**-nodes * r**nodes
    assert strip.nodes(float(strip.error(nodes))) == nodes


@pytest.mark.parametrize(
    ("curves", "message"),
    [
        ([DOUBLE_POINT], "component 1 meets itself or has a cusp, or nearly so"),
        ([CIRCLE, CUSPS + np.outer([1, 0, 0, 0], [0, 0, 5])], "component 2 meets itself or has a cusp, or nearly so"),
        (
            [DOUBLE_POINT + 1e-6 * np.outer([0, 1, 0], [0, 0, 1j])],
            "component 1 meets itself or has a cusp, or nearly so",
        ),
        ([np.zeros((3, 3))], "component 1 meets itself"),
        ([CIRCLE[[0, 0, 1]]], "component 1 meets itself"),
        ([CIRCLE, CIRCLE], "components 1 and 2 meet, or nearly so: no bound of the energy can be proved"),
    ],
    ids=["double point", "cusps", "nearly a double point", "point", "twice round", "twice the same"],
)
def test_curves_without_energy(curves, message):
    with pytest.raises(CurveError, match=message):
        bounds.energy_bounds(curves)


EXACT = np.zeros((6, 3), dtype=complex)  # ((2 + cos 3t) cos 2t, (2 + cos 3t) sin 2t, sin 3t), in few bits
EXACT[[1, 2, 3, 5]] = [[0.5, 0.5j, 0], [2, -2j, 0], [0, 0, -1j], [0.5, -0.5j, 0]]
OF_EXACT = functools.cache(lambda: bounds.energy_bounds([EXACT], 1e-4))


@settings(max_examples=5, deadline=None)
@example(-526)  # where squares begin to vanish
@example(-1070)
@example(1020)
@given(st.integers(-1070, 1020))
def test_bounds_do_not_depend_on_the_unit(exponent):
    assert bounds.energy_bounds([np.ldexp(1.0, exponent) * EXACT], 1e-4) == OF_EXACT()


def test_a_knot_too_small_beside_another_is_refused():
    """As a knot in the middle of a circle, whose squares would vanish even so."""
    with pytest.raises(CurveError, match="component 2 is too small beside the largest"):
        bounds.energy_bounds([CIRCLE, 2.0**-526 * EXACT])


@pytest.mark.parametrize("tolerance", [0.0, -1.0, 1e-11, math.nan, math.inf])
def test_tolerances_that_there_are_not(tolerance):
    with pytest.raises(OptionError, match="give a number from 1e-10 on"):
        bounds.energy_bounds([CIRCLE], tolerance)
