"""Measures of a curve as it stands."""

import numpy as np
import pytest
from mobius_flow.core import Curve, CurveError, RelaxOptions, minimize
from mobius_flow.core.driver.info import Smooth, info, measure
from mobius_flow.core.knots import knot, torus_knot
from shapes import half_circle

# Near a minimum some Möbius directions are so soft that only well converged curves show that they are positive.
EXACT = RelaxOptions(method="trust-region", tolerance=1e-7, stability=True, mesh="fixed")


def circle(count: int) -> Curve:
    angle = 2.0 * np.pi * np.arange(count) / count
    return Curve(np.column_stack([np.cos(angle), np.sin(angle), 0.0 * angle]))


def test_the_circle() -> None:
    found = info(circle(100))
    assert str(found.type) == "unknot"
    assert found.energies["moebius"] == pytest.approx(4.0)
    assert found.ropelength == pytest.approx(2.0 * np.pi, rel=2e-3)
    assert found.writhe == pytest.approx(0.0, abs=1e-12)
    assert found.rest is not None
    assert found.rest.objective == pytest.approx(4.0)
    assert found.rest.sentence == "at rest at a minimum"


def test_a_relaxed_trefoil_is_at_rest_and_its_start_is_not() -> None:
    start = knot("3_1", 80)
    result = minimize(start, EXACT)
    before, after = info(start), info(result.curve)
    assert before.rest is not None
    assert after.rest is not None
    assert before.rest.sentence == "not at rest"
    assert before.rest.index is None
    assert after.rest.index == 0
    assert result.outcome.negative_eigenvalues == 0
    assert after.type.names == before.type.names == ("3_1",)


def test_a_saddle_has_its_index() -> None:
    """Some torus knots are critical points by their symmetry, and no minima."""
    result = minimize(torus_knot(3, 4, 120), EXACT)
    assert result.outcome.converged
    found = info(result.curve).rest
    assert found is not None
    assert found.index == result.outcome.negative_eigenvalues


def test_arcs_have_all_but_a_type() -> None:
    found = info(half_circle(60))
    assert str(found.type) == "not identified"
    assert found.energies["moebius"] == pytest.approx(measure(half_circle(60), "moebius"))
    assert found.rest is not None
    assert found.thickness == pytest.approx(np.cos(np.pi / 120))
    assert found.writhe == pytest.approx(0.0, abs=1e-12)


def test_an_arc_that_relax_takes_for_converged_is_at_rest() -> None:
    """Its energy is about 0, and √E no measure of its gradient."""
    result = minimize(half_circle(40), RelaxOptions(mesh="fixed"))
    assert result.outcome.converged
    found = info(result.curve)
    assert found.rest is not None
    assert found.rest.objective < 1e-4
    assert found.rest.at_rest
    assert found.type.sentence == "none: only closed curves have a knot type, and this one is open"


def test_a_minimum_is_told_on_fine_meshes_too() -> None:
    found = info(circle(500)).rest
    assert found is not None
    assert found.sentence == "at rest at a minimum"


def test_what_takes_too_long_is_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mobius_flow.core.driver.info.REST_UP_TO", 50)
    assert info(circle(50)).rest is not None
    assert info(circle(51)).rest is None


def test_other_dimensions() -> None:
    flat = info(Curve(circle(30).vertices[:, :2]))
    assert str(flat.type) == "not identified"
    assert flat.writhe is None
    assert flat.thickness == pytest.approx(np.cos(np.pi / 30))


def test_curves_that_touch_themselves_are_refused() -> None:
    with pytest.raises(CurveError):
        info(Curve([[0.0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0]]))


def test_a_curve_at_rest_is_told_which_minimum_it_stands_for() -> None:
    smooth = info(minimize(knot("m3_1", 60), RelaxOptions(vertices=60)).curve).smooth
    assert smooth is not None
    assert smooth.sentence.startswith("74.41204")
    assert smooth.sentence.endswith("the least known of 3_1")
    assert info(knot("3_1", 60)).smooth is None  # which is not at rest


def test_a_circle_is_the_least_known_unknot() -> None:
    smooth = info(knot("0_1", 40)).smooth
    assert smooth is not None
    assert smooth.sentence.endswith("the least known of 0_1")


@pytest.mark.parametrize(
    ("energy", "error", "told"),
    [
        (100.0, 1e-4, "100.00000 ± 0.0001, the least known of 9_9"),
        (101.0, 1e-4, "101.00000 ± 0.0001, 1 % above the least known of 9_9, 100"),
        (99.0, 0.01, "99.000 ± 0.01, 1 % below the least known of 9_9, 100"),
        (100.0, 0.0, "100.00000000000000 ± 1e-13, the least known of 9_9"),
    ],
)
def test_other_minima_are_told_apart_from_the_least_known(energy: float, error: float, told: str) -> None:
    assert Smooth(energy, error, "9_9", (100.0, 1e-5)).sentence == told


def test_smooth_curves_of_no_type_in_the_table() -> None:
    assert Smooth(147.3, 0.01, None, None).sentence == "147.300 ± 0.01"
