"""Energies by quadrature of a density: sums done the slow way, circles, rates, the arc distance and its derivative."""

from dataclasses import replace

import numpy as np
import pytest
from dense_stability import tangent_basis
from descent_contracts import point_on
from energy_references import arc_density, circle_density, pair_sum, tangent_point_density
from mobius_flow.core import Curve, MoebiusEnergy
from mobius_flow.core.base.errors import OptionError
from mobius_flow.core.descent.hessian import lagrangian_hessian
from mobius_flow.core.energies import ENERGIES, Energy, KPointEnergy, Rule, moebius_kpoint
from mobius_flow.core.energies.barrier import exact
from mobius_flow.core.energies.densities import (
    EDGE_ENERGY,
    VERTEX_ENERGY,
    ArcDensity,
    IshizekiNagasawaDensity,
    TangentPointDensity,
)
from mobius_flow.core.energies.edge_pairs import EdgePairs
from mobius_flow.core.solve.constraints import Constraints
from mobius_flow.core.solve.metrics import MoebiusMetric
from shapes import hopf_link, regular_polygon
from smooth_curves import SMOOTH_CURVES, dual_circles, random_polygon
from taylor import derivative_slope

GAUSS_2 = ([0.5 - np.sqrt(3) / 6, 0.5 + np.sqrt(3) / 6], [0.5, 0.5])
REFERENCES = {
    "vertex": (0, arc_density, [0.0], [1.0]),
    "edge": (0, arc_density, [0.5], [1.0]),
    "moebius-k2": (4, circle_density, *GAUSS_2),
    "tangent-point": (0, tangent_point_density(3, 6), [0.0, 1.0], [0.5, 0.5]),
}


@pytest.mark.parametrize("name", REFERENCES)
@pytest.mark.parametrize(("sizes", "dimension"), [((8,), 2), ((9,), 3), ((3, 4, 5), 3), ((5, 6), 4)])
def test_sum_over_pairs(name: str, sizes: tuple[int, ...], dimension: int) -> None:
    curve = random_polygon(3, sizes, dimension)
    constant, density, points, weights = REFERENCES[name]
    slow = constant * len(sizes) + pair_sum(curve, density, points, weights)
    assert ENERGIES[name].value(curve) == pytest.approx(slow, rel=1e-12)


@pytest.mark.parametrize("name", ["vertex", "edge", "moebius-k2", "moebius-k3"])
def test_circle_has_energy_4(name: str) -> None:
    """Leaving out neighbours costs O(N⁻¹), whatever the rule."""
    counts = np.array([100, 200, 400, 800])
    errors = np.array([abs(ENERGIES[name].value(regular_polygon(int(n))) - 4) for n in counts])
    assert np.polyfit(np.log(counts), np.log(errors), 1)[0] == pytest.approx(-1, abs=0.1)
    assert errors[-1] < 0.02


@pytest.mark.parametrize("name", ["vertex", "edge", "moebius-k2", "moebius-k3"])
@pytest.mark.parametrize("curve", SMOOTH_CURVES)
def test_smooth_curves(name: str, curve: str) -> None:
    exact = SMOOTH_CURVES[curve].energy
    errors = [abs(ENERGIES[name].value(SMOOTH_CURVES[curve].polygon(n)) - exact) for n in (100, 400)]
    assert errors[1] < 0.5 * errors[0]
    assert errors[1] < 0.02 * exact


@pytest.mark.parametrize("name", ["vertex", "edge", "moebius-k3"])
def test_hopf_link(name: str) -> None:
    assert ENERGIES[name].value(dual_circles(400)) == pytest.approx(8 + 4 * np.pi**2, rel=0.005)


def test_one_gauss_point_is_the_default_energy() -> None:
    curve = random_polygon(5, (9, 7), 3)
    value, derivative = moebius_kpoint(1).value_and_derivative(curve)
    expected_value, expected_derivative = MoebiusEnergy().value_and_derivative(curve)
    assert value == pytest.approx(expected_value, rel=1e-13)
    scale = np.abs(expected_derivative).max()
    np.testing.assert_allclose(derivative, expected_derivative, rtol=0, atol=1e-12 * scale)


def quadrature_error(points: int, size: float, seed: int) -> float:
    """Relative error of Σ W_IJ between two triangles, ``size`` large and about 2 apart, against ∬ F."""
    first, second = size * np.random.default_rng(seed).normal(size=(2, 3, 3))
    curve = Curve.from_components([first, second + np.array([2.0, 0.5, 0.3])])
    rows, columns = (np.ravel(index) for index in np.meshgrid([0, 1, 2], [3, 4, 5]))
    reference = 2 * float(exact(EdgePairs.of(curve.mesh, curve.vertices, rows, columns)).value.sum())
    return abs(moebius_kpoint(points).value(curve) - 8 - reference) / reference


@pytest.mark.parametrize("points", [1, 2, 3])
def test_order_of_the_rule_on_far_pairs(points: int) -> None:
    """W_IJ → ∬ F at the order 2k of the k-point rule as edges shrink."""
    sizes = [0.2, 0.1, 0.05]
    errors = [np.mean([quadrature_error(points, size, seed) for seed in range(12)]) for size in sizes]
    assert np.polyfit(np.log(sizes), np.log(errors), 1)[0] == pytest.approx(2 * points, abs=0.15)


@pytest.mark.parametrize("energy", [VERTEX_ENERGY, EDGE_ENERGY], ids=lambda e: e.name)
@pytest.mark.parametrize("sizes", [(12,), (5, 8)])
def test_arc_derivative(energy: KPointEnergy, sizes: tuple[int, ...]) -> None:
    """Complete it is a derivative; without it (footnote 5 of [RS21]) only the projected gradient is right."""
    curve = random_polygon(7, sizes, 3)
    without = KPointEnergy(energy.name, energy.description, energy.density, energy.rule, arc_derivative=False)
    v = np.random.default_rng(3).normal(size=curve.vertices.shape)
    assert derivative_slope(energy, curve, v, largest=1e-3) == pytest.approx(2, abs=0.01)
    assert derivative_slope(without, curve, v, largest=1e-3) == pytest.approx(1, abs=0.01)

    full, partial = (e.value_and_derivative(curve)[1] for e in (energy, without))
    assert np.abs(full - partial).max() > 1e-3 * np.abs(full).max()
    saddle = MoebiusMetric().at(curve).tangent_space(Constraints.of(curve).derivative(curve))
    projected, expected = saddle.gradient(partial)[0], saddle.gradient(full)[0]
    np.testing.assert_allclose(projected, expected, rtol=0, atol=1e-10 * np.abs(expected).max())


@pytest.mark.parametrize("energy", [VERTEX_ENERGY, EDGE_ENERGY], ids=lambda e: e.name)
def test_second_derivatives_along_the_constraints_need_no_arc_derivative(energy: KPointEnergy) -> None:
    """Nor does the Lagrangian change where arcs are equally long, though the energy has a kink there."""
    without = KPointEnergy(energy.name, energy.description, energy.density, energy.rule, arc_derivative=False)
    for curve in (random_polygon(7, (12,), 3), regular_polygon(12), hopf_link(10)):
        point = point_on(curve, energy=energy)
        points = [point, point.changing(objective=replace(point.problem.objective, energy=without))]
        basis = tangent_basis(points[0].tangent_space.constraints)
        full, partial = (
            basis.T @ np.array([lagrangian_hessian(point)(b.reshape(curve.vertices.shape)).ravel() for b in basis.T]).T
            for point in points
        )
        np.testing.assert_allclose(partial, full, rtol=0, atol=1e-11 * np.abs(full).max())
        np.testing.assert_allclose(full, full.T, rtol=0, atol=1e-11 * np.abs(full).max())


@pytest.mark.parametrize("energy", [VERTEX_ENERGY, EDGE_ENERGY], ids=lambda e: e.name)
@pytest.mark.parametrize("n", [12, 13])
def test_a_regular_polygon_keeps_its_symmetry_at_the_kink(energy: KPointEnergy, n: int) -> None:
    """With n even there are opposite edges, equally far both ways round."""
    curve = regular_polygon(n)
    derivative = energy.value_and_derivative(curve)[1]
    radial = np.einsum("ij,ij->i", derivative, curve.vertices)
    np.testing.assert_allclose(radial, radial[0], rtol=0, atol=1e-12)
    # dimensionless energies do not change along the vertices themselves
    assert abs(radial.sum()) < 1e-11


@pytest.mark.parametrize("energy", ENERGIES.values(), ids=ENERGIES)
def test_the_derivative_along_the_vertices_is_the_exponent_times_the_energy(energy: Energy) -> None:
    """Euler's theorem on homogeneous functions: ⟨DE, P⟩ = s E, which is 0 for dimensionless energies."""
    curve = random_polygon(9, (10, 6), 3)
    value, derivative = energy.value_and_derivative(curve)
    along = np.sum(derivative * curve.vertices)
    assert abs(along - energy.scale_exponent * value) < 1e-11 * np.abs(derivative).max()


def test_an_energy_of_ones_own() -> None:
    """A density and a rule make an energy with its derivative."""
    energy = KPointEnergy("mine", "three points", TangentPointDensity(2.0, 4.5), Rule.gauss(3))
    curve = random_polygon(11, (10,), 3)
    v = np.random.default_rng(3).normal(size=curve.vertices.shape)
    assert derivative_slope(energy, curve, v, largest=1e-3) == pytest.approx(2, abs=0.01)


def test_densities_are_unchanged_if_points_change_places() -> None:
    """Rules on reversed curves pair the same points with tangents the other way."""
    curve = random_polygon(13, (9, 5), 3)
    turned = Curve.from_components([part[::-1] for part in curve.components])
    for density in (ArcDensity(), IshizekiNagasawaDensity(), TangentPointDensity()):
        energy = KPointEnergy("", "", density, Rule.gauss(2))
        assert energy.value(turned) == pytest.approx(energy.value(curve), rel=1e-13)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: moebius_kpoint(0), "points is 0"),
        (lambda: Rule.gauss(-1), "points is -1"),
        (lambda: Rule((), ()), "0 points, 0 weights"),
        (lambda: Rule((0.5,), (0.5, 0.5)), "1 points, 2 weights"),
        (lambda: Rule((1.5,), (1.0,)), "between 0 and 1"),
        (lambda: Rule((0.5,), (0.9,)), "add up to 1"),
        (lambda: TangentPointDensity(1.0, 3.0), "alpha is 1.0"),
        (lambda: TangentPointDensity(3.0, 7.0), "beta is 7.0"),
        (lambda: TangentPointDensity(3.0, 4.0), "beta is 4.0"),
        (lambda: TangentPointDensity(float("nan"), 4.0), "alpha is nan"),
    ],
)
def test_options_are_checked(make: object, message: str) -> None:
    assert callable(make)
    with pytest.raises(OptionError, match=message):
        make()
