"""What a sample of edges tells of the compressed energy's errors, against the errors themselves."""

from functools import cache
from itertools import combinations

import numpy as np
import pytest
from hard_curves import bent_trefoil
from mobius_flow.core.curve.refine import refine, subdivide
from mobius_flow.core.descent import Point
from mobius_flow.core.driver import RelaxOptions
from mobius_flow.core.driver.prepare import start_problem
from mobius_flow.core.energies.barrier import replaced_pairs
from mobius_flow.core.energies.hierarchy import HierarchicalMoebiusEnergy, SampledErrors, moebius_energy
from mobius_flow.core.energies.hierarchy.energy import Estimate, energy_error, slope_error
from mobius_flow.core.knots import knot
from shapes import chain_of_rings, graded_trefoil

CURVES = {
    "smooth": bent_trefoil(1500),
    "tangle": subdivide(refine(knot("ochiai-1"), 300), np.full(300, 4)),
    "table": refine(knot("goeritz"), 1000),
    "graded": graded_trefoil(1500, 20.0),
    "links": chain_of_rings(20, (60, 90)),
}
CURVE = pytest.mark.parametrize("name", CURVES)


@cache
def point(name: str) -> Point:
    options = RelaxOptions(solver="hierarchical", mesh="fixed", vertices=len(CURVES[name]))
    return start_problem(CURVES[name], options).at_curve(CURVES[name])


@cache
def energy(name: str) -> HierarchicalMoebiusEnergy:
    """The energy that a run looks at there."""
    curve = point(name).curve
    return HierarchicalMoebiusEnergy(without=replaced_pairs(curve)).frozen_at(curve)


@cache
def true_errors(name: str) -> tuple[float, float]:
    """Of the energy and of its derivative along the projected gradient."""
    curve = point(name).curve
    value, derivative = energy(name).value_and_derivative(curve)
    exact, exact_derivative = energy(name).exact.value_and_derivative(curve)
    return value - exact, float(np.sum((derivative - exact_derivative) * point(name).gradient))


@CURVE
def test_rows_add_up(name: str) -> None:
    curve = point(name).curve
    pairs = energy(name).exact.value(curve) - 4.0 * len(curve.mesh.component_sizes)
    rows = energy(name).exact.row_energies(curve, np.arange(len(curve)))
    assert rows.sum() == pytest.approx(pairs, rel=1e-12)
    fast = energy(name).row_energies(curve)
    np.testing.assert_allclose(fast, rows, atol=1e-4 * np.abs(rows).max())
    assert fast.sum() == pytest.approx(energy(name).value(curve) - 4.0 * len(curve.mesh.component_sizes), rel=1e-12)


@CURVE
@pytest.mark.parametrize("count", [100, 512, 10_000])
def test_errors_are_within_three_standard_errors_of_what_a_sample_tells(name: str, count: int) -> None:
    """A sample of all edges tells the errors themselves."""
    curve, (of_energy, of_slope) = point(name).curve, true_errors(name)
    for estimate, true in (
        (energy_error(energy(name), curve, count), of_energy),
        (slope_error(energy(name), curve, point(name).gradient, count), of_slope),
    ):
        rounding = 1e-8 * abs(point(name).energy)
        assert count < len(curve) or estimate.standard_error == 0.0
        assert abs(estimate.mean - true) < 3.0 * estimate.standard_error + rounding
        assert abs(true) < estimate.bound + rounding


@CURVE
def test_by_default_a_sample_tells_the_errors_that_are_wanted_by_default(name: str) -> None:
    """Its standard errors are a third of them at most, so that they are what decides."""
    at = point(name)
    errors = SampledErrors.at(energy(name), at.curve, at.energy, at.gradient, at.gradient_norm)
    assert errors.energy.standard_error < 3e-7
    assert errors.gradient_norm.standard_error < 1.5e-5
    assert errors.within(1e-4)
    assert not errors.within(1e-12)


@pytest.mark.parametrize("count", [2, 4, 6])
def test_standard_errors_are_those_of_samples_without_replacement(count: int) -> None:
    """Squared and averaged over all samples of six numbers they are the variance of the sum that is told."""
    numbers = np.array([1.0, -2.0, 4.0, 0.5, 3.0, 9.0])
    told = [Estimate.of_sum(numbers[list(chosen)], 6, rest=5.0) for chosen in combinations(range(6), count)]
    assert np.mean([each.mean for each in told]) == pytest.approx(5.0 + numbers.sum())
    variance = np.var([each.mean for each in told])
    assert np.mean([each.standard_error**2 for each in told]) == pytest.approx(variance, abs=1e-12)


def test_the_reported_energy_says_its_error_where_it_is_not_exact(monkeypatch: pytest.MonkeyPatch) -> None:
    curve = bent_trefoil(2000)
    exact, error = moebius_energy(curve)
    assert error == 0.0
    monkeypatch.setattr("mobius_flow.core.energies.hierarchy.energy.EXACT_UP_TO", 1000)
    value, bound = moebius_energy(curve)
    assert 0.0 < abs(value - exact) < bound * value < 1e-6 * value
