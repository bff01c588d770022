"""What every energy promises: sums and derivatives that are right, invariances, known values approached at a rate."""

from typing import NamedTuple

import numpy as np
import pytest
from energy_references import arc_density, circle_density, pair_sum, tangent_point_density
from hypothesis import given, settings
from hypothesis import strategies as st
from mobius_flow.core import Curve, Objective
from mobius_flow.core.energies import ENERGIES, TERMS, Barrier, Bending, Energy, is_moebius_invariant, moebius_kpoint
from mobius_flow.core.energies.barrier import near_pairs
from mobius_flow.core.knots import knot
from shapes import crossing, lattice_knot, opened, regular_polygon, straight_arc
from smooth_curves import SMOOTH_CURVES, dual_circles, random_polygon
from taylor import derivative_slope, hessian_slope, taylor_slope

ALL = {
    **ENERGIES,
    "moebius-k1": moebius_kpoint(1),
    "objective": Objective(),
    "without barrier": Objective(barrier=None),
    "barrier": Barrier(),
    "bending": Bending(),
}
EVERY = {**ALL, **TERMS}  # terms may depend on anything
ENERGY = pytest.mark.parametrize("energy", ALL.values(), ids=ALL)
ASSEMBLED = [energy for energy in ALL.values() if hasattr(energy, "hessian")]


def star(n):
    """A polygon of the plane that does not cross itself."""
    t, r = 2 * np.pi * np.arange(n) / n, np.random.default_rng(1).uniform(0.5, 1.5, n)
    return Curve(np.stack([r * np.cos(t), r * np.sin(t)], axis=1))


CURVES = {
    "plane": star(11),
    "knot": random_polygon(3, (13,), 3),
    "link": random_polygon(5, (3, 4, 5), 3),
    "fourfold": random_polygon(7, (6, 7), 4),
    "arcs": opened(random_polygon(5, (3, 4, 5), 3), 0, 2),
}
NEAR = {f"gap {gap}": crossing(gap) for gap in (0.3, 0.05, 1e-3, 1e-5)}
COARSE = {"lattice": lattice_knot("3_1"), "diagram": knot("thistlethwaite")}


def direction_for(curve):
    return np.random.default_rng(11).normal(size=curve.vertices.shape)


@pytest.mark.parametrize(
    ("energy", "curve", "largest"),
    [
        *(pytest.param(e, c, 1e-3, id=f"{name}-{of}") for name, e in EVERY.items() for of, c in CURVES.items()),
        *(pytest.param(Objective(), c, min(1e-3, 0.01 * np.ptp(c.vertices[:, 2])), id=k) for k, c in NEAR.items()),
        *(pytest.param(Objective(), c, 0.01, id=k) for k, c in COARSE.items()),
    ],
)
def test_values_and_derivatives_fit_together(energy, curve, largest):
    v = direction_for(curve)
    value, derivative = energy.value_and_derivative(curve)
    assert energy.value(curve) == pytest.approx(value, rel=1e-14)
    assert derivative_slope(energy, curve, v, largest) == pytest.approx(2, abs=0.02)
    if not hasattr(energy, "hessian_product"):
        return
    assert hessian_slope(energy, curve, v, largest) == pytest.approx(3, abs=0.05)

    def along(t):
        return energy.value_and_derivative(curve.with_vertices(curve.vertices + t * v))[1]

    assert taylor_slope(along, [derivative, energy.hessian_product(curve, v)], largest) == pytest.approx(2, abs=0.05)


@pytest.mark.parametrize("energy", ASSEMBLED, ids=lambda each: type(each).__name__)
@pytest.mark.parametrize("curve", [*CURVES.values(), crossing(0.05), dual_circles(150)], ids=[*CURVES, "near", "tiles"])
def test_hessians_are_symmetric_and_have_the_products(energy, curve):
    matrix, v = energy.hessian(curve), direction_for(curve)
    rounding = 8 * curve.mesh.edges * np.finfo(float).eps  # an entry is a sum over the edges, added in either order
    np.testing.assert_allclose(matrix, matrix.T, rtol=0, atol=rounding * np.abs(matrix).max())
    product = energy.hessian_product(curve, v).ravel()
    np.testing.assert_allclose(matrix @ v.ravel(), product, rtol=0, atol=1e-12 * np.abs(product).max())


class Sum(NamedTuple):
    """What an energy is pair by pair."""

    constant: float
    density: object
    points: list[float]
    weights: list[float]


REFERENCES = {
    "moebius": Sum(4, circle_density, [0.5], [1.0]),
    "vertex": Sum(0, arc_density, [0.0], [1.0]),
    "edge": Sum(0, arc_density, [0.5], [1.0]),
    "moebius-k2": Sum(4, circle_density, [0.5 - np.sqrt(3) / 6, 0.5 + np.sqrt(3) / 6], [0.5, 0.5]),
    "tangent-point": Sum(0, tangent_point_density(3, 6), [0.0, 1.0], [0.5, 0.5]),
}
POLYGONS = {name: CURVES[name] for name in ("knot", "link", "fourfold")}
POLYGONS |= {"plane": random_polygon(3, (8,), 2), "lattice": lattice_knot("4_1")}


@pytest.mark.parametrize("name", REFERENCES)
@pytest.mark.parametrize("curve", POLYGONS.values(), ids=POLYGONS)
def test_sums_over_pairs(name, curve):
    constant, density, points, weights = REFERENCES[name]
    slow = constant * len(curve.components) + pair_sum(curve, density, points, weights)
    assert ENERGIES[name].value(curve) == pytest.approx(slow, rel=1e-12)


def rings(n, ratio=1.8):
    polygon = regular_polygon(n, 2).vertices
    return Curve.from_components([polygon, ratio * polygon])


KNOWN = {
    **{name: (curve.polygon, curve.energy) for name, curve in SMOOTH_CURVES.items()},
    "circle": (regular_polygon, 4.0),
    "Hopf": (dual_circles, 8 + 4 * np.pi**2),
    # in the plane ∬ cos α/r² over two closed curves vanishes, and ∬ 1/r² is 4π² R/(R² − 1) for radii 1 and R
    "concentric": (rings, 8 + 2 * 4 * np.pi**2 * 1.8 / (1.8**2 - 1)),
}


@pytest.mark.parametrize("name", [name for name, each in ENERGIES.items() if is_moebius_invariant(each)])
@pytest.mark.parametrize("of", KNOWN)
def test_known_energies_are_approached(name, of):
    """Leaving out neighbours costs O(N⁻¹) whatever the rule, but for the default energy, whose density is 0 there."""
    curve, exact = KNOWN[of]
    counts = np.array([100, 200, 400, 800])
    errors = np.array([abs(ENERGIES[name].value(curve(int(n))) - exact) for n in counts])
    if name == "moebius" and of == "circle":
        assert errors.max() < 1e-11
        return
    assert errors[2] < 0.5 * errors[0]
    assert errors[-1] < (2e-4 if name == "moebius" else 0.02) * exact
    if name == "moebius" or of == "circle":
        rate = 2 if name == "moebius" else 1
        assert np.polyfit(np.log(counts), np.log(errors), 1)[0] == pytest.approx(-rate, abs=0.1)


def wound(seed):
    """Two strands side by side, not smooth, some edges nearer to each other than they are long."""
    t = 4 * np.pi * np.arange(24) / 24
    r = 1 + 0.12 * np.cos(1.5 * t)
    points = np.stack([r * np.cos(t), r * np.sin(t), 0.15 * np.sin(1.5 * t)], axis=1)
    return Curve(points + 0.02 * np.random.default_rng(seed).normal(size=points.shape))


def scale_exponent(energy):
    """Of the energy under scaling; the barrier has none of its own: its energy is dimensionless."""
    return getattr(energy, "scale_exponent", 0.0)


def is_one_sided(energy):
    """Whether its points on an edge are others from the other end: then unequal edges tell orientations apart."""
    points = np.array(energy.rule.points) if isinstance(energy, Energy) else np.array([0.5])
    return not np.allclose(np.sort(points), np.sort(1.0 - points))


def test_exponents_sides_and_the_barrier_are_those_of_these_tests():
    assert next(iter(ENERGIES)) == "moebius"
    assert {name: scale_exponent(each) for name, each in ALL.items() if scale_exponent(each)} == {"tangent-point": -1}
    assert {name for name, energy in ALL.items() if is_one_sided(energy)} == {"vertex"}
    assert all(abs(Barrier().value(wound(seed))) > 1 for seed in (1, 2, 3))
    assert all(len(near_pairs(curve)[0]) for curve in NEAR.values())


@ENERGY
@given(seed=st.integers(0, 999), log_scale=st.floats(-30, 30))
@settings(max_examples=10, deadline=None)
def test_similarities(energy, seed, log_scale):
    curve, scale = wound(seed), 10.0**log_scale
    rotation = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    moved = curve.with_vertices(scale * (curve.vertices @ rotation + [1.0, -2.0, 3.0]))
    value, derivative = energy.value_and_derivative(curve)
    moved_value, moved_derivative = energy.value_and_derivative(moved)
    factor = scale ** scale_exponent(energy)
    assert moved_value == pytest.approx(factor * value, rel=1e-9, abs=1e-9 * factor)
    expected = derivative @ rotation * (factor / scale)
    np.testing.assert_allclose(moved_derivative, expected, rtol=0, atol=1e-7 * np.abs(expected).max())


@ENERGY
def test_far_from_the_origin(energy):
    curve, away = SMOOTH_CURVES["trefoil"].polygon(60), np.array([1e6, -2e6, 3e6])
    far = curve.with_vertices(curve.vertices + away)
    rounded = far.with_vertices(far.vertices - away)  # what is left of the curve, exactly
    value, derivative = energy.value_and_derivative(rounded)
    far_value, far_derivative = energy.value_and_derivative(far)
    assert far_value == pytest.approx(value, rel=1e-9)
    np.testing.assert_allclose(far_derivative, derivative, rtol=0, atol=1e-8 * max(np.abs(derivative).max(), 1e-30))


@ENERGY
def test_arcs(energy):
    """They do not depend on place, size and direction either; straight ones have no energy if it is a Möbius energy."""
    if is_moebius_invariant(energy):
        assert energy.value(straight_arc(40)) == pytest.approx(0.0, abs=1e-12)
    arc = opened(random_polygon(5, (12,), 3), 0)
    value, rotation = energy.value(arc), np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    moved = arc.with_vertices(3.0 * (arc.vertices @ rotation.T + 5.0))
    assert energy.value(moved) == pytest.approx(3.0 ** scale_exponent(energy) * value, rel=1e-10)
    if not is_one_sided(energy):
        assert energy.value(arc.with_vertices(arc.vertices[::-1])) == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize("name", ["moebius", "moebius-k2"])
def test_sphere_inversions_in_the_limit(name):
    """Möbius transformations change the energy of polygons by O(N⁻²), that of more points by O(N⁻¹)."""
    differences = []
    for n in (200, 400):
        curve = SMOOTH_CURVES["trefoil"].polygon(n)
        from_centre = curve.vertices - np.array([6.0, 1.0, 2.0])
        inverted = curve.with_vertices(from_centre / np.sum(from_centre**2, axis=1)[:, None])
        differences.append(abs(ENERGIES[name].value(inverted) - ENERGIES[name].value(curve)))
    assert differences[1] < (0.3 if name == "moebius" else 0.6) * differences[0]
