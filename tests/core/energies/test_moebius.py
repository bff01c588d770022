"""The default energy: known values, rates, links, and sums done the slow way."""

import numpy as np
import pytest
from energy_references import circle_density, disjoint_pairs, pair_sum
from mobius_flow.core import Curve, MoebiusEnergy
from mobius_flow.core.energies import ENERGIES
from mobius_flow.core.knots import knot
from shapes import lattice_knot, regular_polygon
from smooth_curves import SMOOTH_CURVES, dual_circles, random_polygon

ENERGY = MoebiusEnergy()


def test_it_is_the_default() -> None:
    assert next(iter(ENERGIES)) == "moebius"


@pytest.mark.parametrize("n", [3, 4, 5, 6, 7, 17, 64, 301, 1000])
@pytest.mark.parametrize("dimension", [2, 3, 4])
def test_regular_polygons_have_energy_4(n: int, dimension: int) -> None:
    assert ENERGY.value(regular_polygon(n, dimension)) == pytest.approx(4, abs=1e-12)


@pytest.mark.parametrize("name", SMOOTH_CURVES)
def test_smooth_curves_at_the_rate_of_the_midpoint_rule(name: str) -> None:
    counts = np.array([100, 200, 400, 800])
    curve, exact = SMOOTH_CURVES[name], SMOOTH_CURVES[name].energy
    errors = np.array([abs(ENERGY.value(curve.polygon(int(n))) - exact) for n in counts])
    assert np.polyfit(np.log(counts), np.log(errors), 1)[0] == pytest.approx(-2, abs=0.1)
    assert errors[-1] < 1.5e-4 * exact


def test_trefoil_excess_as_published() -> None:
    excess = [ENERGY.value(SMOOTH_CURVES["trefoil"].polygon(n)) - 81.840852989 for n in (100, 200, 400, 800)]
    assert excess == pytest.approx([0.1686, 0.0411, 0.0101, 0.00252], abs=1e-4)


def test_hopf_link() -> None:
    counts = np.array([50, 100, 200, 400])
    errors = [ENERGY.value(dual_circles(int(n))) - (8 + 4 * np.pi**2) for n in counts]
    assert np.polyfit(np.log(counts), np.log(np.abs(errors)), 1)[0] == pytest.approx(-2, abs=0.1)
    assert abs(errors[-1]) < 2e-3


def test_concentric_circles() -> None:
    """In the plane: ∬ cos α/r² over two closed curves vanishes, and ∬ 1/r² is 4π² R/(R² − 1) for radii 1 and R."""
    counts = np.array([50, 100, 200, 400])
    polygons = [regular_polygon(int(n), 2).vertices for n in counts]
    exact = 8 + 2 * 4 * np.pi**2 * 1.8 / (1.8**2 - 1)
    errors = [abs(ENERGY.value(Curve.from_components([p, 1.8 * p])) - exact) for p in polygons]
    assert np.polyfit(np.log(counts), np.log(errors), 1)[0] == pytest.approx(-2, abs=0.1)
    assert errors[-1] < 2e-4 * exact


@pytest.mark.parametrize("n", [5, 30, 200])
def test_orthogonal_circles_in_four_dimensions(n: int) -> None:
    """Two circles of the Clifford torus: all tangents are orthogonal to each other and to the chords."""
    polygon, zero = regular_polygon(n, 2).vertices, np.zeros((n, 2))
    link = Curve.from_components([np.hstack([polygon, zero]), np.hstack([zero, polygon])])
    assert ENERGY.value(link) == pytest.approx(8 + 4 * n**2 * np.tan(np.pi / n) ** 2, rel=1e-12)


@pytest.mark.parametrize("dimension", [2, 3, 4])
def test_separate_circles_do_not_see_each_other_far_away(dimension: int) -> None:
    circle = regular_polygon(60, dimension).vertices
    energies = []
    for distance in (10.0, 100.0):
        shift = np.zeros(dimension)
        shift[0] = distance
        energies.append(ENERGY.value(Curve.from_components([circle, circle + shift])))
    # the density decays like 1/r², once for each order of the pair
    assert energies[0] - 8 == pytest.approx(2 * (2 * np.pi / 10) ** 2, rel=0.1)
    assert energies[1] - 8 == pytest.approx(2 * (2 * np.pi / 100) ** 2, rel=0.01)


@pytest.mark.parametrize(("sizes", "dimension"), [((9,), 2), ((12,), 3), ((3, 4, 5), 3), ((6, 7), 4)])
def test_sum_over_pairs(sizes: tuple[int, ...], dimension: int) -> None:
    curve = random_polygon(3, sizes, dimension)
    slow = 4 * len(sizes) + pair_sum(curve, circle_density, [0.5], [1.0])
    assert ENERGY.value(curve) == pytest.approx(slow, rel=1e-13)


@pytest.mark.parametrize("dimension", [2, 3, 4])
def test_formula_of_the_local_contribution(dimension: int) -> None:
    """The reference's angle is the formula of Ishizeki and Nagasawa."""
    rng = np.random.default_rng(9)
    for _ in range(20):
        x, y, e, f = rng.normal(size=(4, dimension))
        delta, lengths = x - y, np.linalg.norm(e) * np.linalg.norm(f)
        s = 1 / (delta @ delta)
        formula = (lengths + e @ f) * s - 2 * (delta @ e) * (delta @ f) * s**2
        angle = lengths * circle_density(x, y, e / np.linalg.norm(e), f / np.linalg.norm(f), 0.0)
        assert formula == pytest.approx(angle, rel=1e-12)
        assert formula >= 0


@pytest.mark.parametrize("curve", [lattice_knot("4_1"), knot("culprit")], ids=["lattice", "diagram"])
def test_coarse_knots(curve: Curve) -> None:
    expected = 4 + pair_sum(curve, circle_density, [0.5], [1.0])
    assert ENERGY.value(curve) == pytest.approx(expected, rel=1e-12)


def test_triangles_have_no_disjoint_edges() -> None:
    curve = Curve([[0, 0], [1, 0], [0, 1.0]])
    assert not list(disjoint_pairs(curve))
    energy, derivative = ENERGY.value_and_derivative(curve)
    assert energy == 4
    assert not derivative.any()
    assert not ENERGY.hessian(curve).any()
