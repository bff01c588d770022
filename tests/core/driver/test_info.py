"""Measures of a curve as it stands."""

import numpy as np
import pytest
from mobius_flow.core import Curve, CurveError, RelaxOptions, minimize
from mobius_flow.core.driver.info import Smooth, info, measure
from mobius_flow.core.knots import knot, torus_knot
from shapes import half_circle, regular_polygon

# Near a minimum some Möbius directions are so soft that only well converged curves show that they are positive.
EXACT = RelaxOptions(method="trust-region", tolerance=1e-7, stability=True, mesh="fixed")


@pytest.mark.parametrize(
    ("curve", "kind", "thickness", "energy"),
    [
        (regular_polygon(100), "unknot", np.cos(np.pi / 100), 4.0),
        (regular_polygon(500), "unknot", np.cos(np.pi / 500), 4.0),
        (regular_polygon(30, dimension=2), "not identified", np.cos(np.pi / 30), 4.0),
        (half_circle(60), "not identified", np.cos(np.pi / 120), measure(half_circle(60), "moebius")),
    ],
    ids=["circle", "fine circle", "plane", "arc"],
)
def test_circles_and_arcs(curve, kind, thickness, energy):
    found = info(curve)
    assert str(found.type) == kind
    assert found.energies["moebius"] == pytest.approx(energy)
    assert found.thickness == pytest.approx(thickness)
    assert found.ropelength == pytest.approx(found.length / thickness)
    assert found.writhe is None if curve.dimension == 2 else found.writhe == pytest.approx(0.0, abs=1e-12)
    assert found.open or found.rest.sentence == "at rest at a minimum"


def test_a_saddle_has_its_index():
    """Some torus knots are critical points by their symmetry, and no minima."""
    result = minimize(torus_knot(3, 4, 120), EXACT)
    assert result.outcome.converged
    found = info(result.curve).rest
    assert found.index == result.outcome.negative_eigenvalues


def test_what_takes_too_long_is_left_out_and_what_touches_refused(monkeypatch):
    monkeypatch.setattr("mobius_flow.core.driver.info.REST_UP_TO", 50)
    assert info(regular_polygon(50)).rest is not None
    assert info(regular_polygon(51)).rest is None
    assert [info(regular_polygon(n)).rest is None for n in (3, 4, 5)] == [True, True, False]  # singular metrics
    with pytest.raises(CurveError):
        info(Curve([[0.0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0]]))


def test_a_curve_at_rest_is_told_which_minimum_it_stands_for():
    smooth = info(minimize(knot("m3_1", 60), RelaxOptions(vertices=60)).curve).smooth
    assert smooth.sentence.startswith("74.41204")
    assert smooth.sentence.endswith("the least known of 3_1")
    assert info(knot("3_1", 60)).smooth is None  # which is not at rest
    circle = info(knot("0_1", 40)).smooth
    assert circle.sentence.endswith("the least known of 0_1")


@pytest.mark.parametrize(
    ("energy", "error", "name", "told"),
    [
        (100.0, 1e-4, "9_9", "100.00000 ± 0.0001, the least known of 9_9"),
        (101.0, 1e-4, "9_9", "101.00000 ± 0.0001, 1 % above the least known of 9_9, 100"),
        (99.0, 0.01, "9_9", "99.000 ± 0.01, 1 % below the least known of 9_9, 100"),
        (100.0, 0.0, "9_9", "100.00000000000000 ± 1e-13, the least known of 9_9"),
        (147.3, 0.01, None, "147.300 ± 0.01"),
    ],
)
def test_other_minima_are_told_apart_from_the_least_known(energy, error, name, told):
    assert Smooth(energy, error, name, (100.0, 1e-5) if name else None).sentence == told
