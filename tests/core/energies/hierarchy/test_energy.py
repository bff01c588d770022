"""The compressed Möbius energy against the sum over all pairs, and its derivative."""

import numpy as np
import pytest
from families import crossed
from mobius_flow.core import Curve, MoebiusEnergy, Objective
from mobius_flow.core.curve.refine import refine, subdivide
from mobius_flow.core.energies.barrier import replaced_pairs
from mobius_flow.core.energies.hierarchy import BlockList, HierarchicalMoebiusEnergy
from mobius_flow.core.knots import knot
from mobius_flow.core.solve.metrics import FractionalMetric, L2Metric
from mobius_flow.core.solve.metrics.moebius import MoebiusMetric
from shapes import hopf_link, scattered_rings, torus_trefoil
from smooth_curves import SMOOTH_CURVES, random_polygon
from taylor import derivative_slope


def fourfold(n):
    """A curve of four dimensions."""
    rotation, _ = np.linalg.qr(np.random.default_rng(1).normal(size=(4, 4)))
    t = 2 * np.pi * np.arange(n) / n
    return Curve(np.column_stack([torus_trefoil(n).vertices, np.cos(5 * t)]) @ rotation)


CURVES = {
    "torus": torus_trefoil(350),
    "hopf": hopf_link(150),
    "wave": SMOOTH_CURVES["wave"].polygon(250),
    "ellipse": SMOOTH_CURVES["ellipse"].polygon(250),
    "fourfold": fourfold(150),
    "rings": scattered_rings(60, 5, 20.0),
    "planar rings": scattered_rings(50, 3, 20.0, 2),
    "table": refine(knot("8_19"), 400),
    "tangle": subdivide(random_polygon(3, (30,), 3), np.full(30, 15)),
    "uneven": Curve.from_components([torus_trefoil(201).vertices, *scattered_rings(20, 3, 20.0).components]),
}


@pytest.fixture(autouse=True)
def lists(monkeypatch):
    """Near pairs are listed even where, as on curves as small as these, they are most of all."""
    monkeypatch.setattr("mobius_flow.core.energies.hierarchy.blocks.MOSTLY_NEAR", 1.0)


CURVE = pytest.mark.parametrize("curve", CURVES.values(), ids=CURVES)


def with_small_leaves(curve, theta=HierarchicalMoebiusEnergy.theta):
    """The energy with many blocks even on small curves."""
    energy = HierarchicalMoebiusEnergy(blocks=BlockList.of(curve, theta, 4))
    assert len(energy.blocks.first) > len(curve) / 4
    return energy


def direction_for(curve):
    return np.random.default_rng(11).normal(size=curve.vertices.shape)


@CURVE
def test_energy_to_six_digits_and_derivative_to_four(curve):
    fast = with_small_leaves(curve)
    energy, derivative = fast.value_and_derivative(curve)
    exact, exact_derivative = MoebiusEnergy().value_and_derivative(curve)
    assert energy == pytest.approx(exact, rel=1e-6, abs=3e-5)
    assert fast.value(curve) == pytest.approx(energy, rel=1e-14)
    inner = MoebiusMetric().at(curve)

    def dual_norm(covector):
        return float(np.sqrt(np.sum(covector * np.linalg.solve(inner.dense(), covector))))

    assert dual_norm(derivative - exact_derivative) < 1e-4 * dual_norm(exact_derivative)
    assert derivative_slope(fast, curve, direction_for(curve), largest=1e-4) == pytest.approx(2, abs=0.02)


@pytest.mark.parametrize(("name", "smooth"), crossed(CURVES, [True, False]))
def test_products_with_the_second_derivative_to_four_digits(name, smooth):
    curve = CURVES[name]
    gram, noise = FractionalMetric().at(curve).plus(L2Metric().at(curve)).dense(), direction_for(curve)
    v = np.linalg.solve(gram, noise) if smooth else noise
    exact = MoebiusEnergy().hessian_product(curve, v)
    error = with_small_leaves(curve).hessian_product(curve, v) - exact
    of_error, of_exact = (np.sum(each * np.linalg.solve(gram, each)) for each in (error, exact))
    assert of_error < 1e-8 * of_exact
    np.testing.assert_array_equal(with_small_leaves(curve).hessian_product(curve, 0.0 * v), 0.0 * v)


def test_error_falls_with_the_fifth_power_of_separation():
    curve = CURVES["tangle"]
    exact = MoebiusEnergy().value_and_derivative(curve)[1]
    errors = [
        np.linalg.norm(with_small_leaves(curve, theta).value_and_derivative(curve)[1] - exact) for theta in (0.3, 0.15)
    ]
    assert errors[0] > 2**5 * errors[1]


def test_places_and_units():
    """Coordinates of 10⁶ are rounded by some 10⁻⁹ of an edge, and the derivative sees angles between edges."""
    energy, curve = HierarchicalMoebiusEnergy(), torus_trefoil(500)
    value, derivative = energy.value_and_derivative(curve)
    moved_value, moved = energy.value_and_derivative(curve.with_vertices(curve.vertices + 1e6))
    assert moved_value == pytest.approx(value, rel=1e-11)
    np.testing.assert_allclose(moved, derivative, atol=2e-6 * np.abs(derivative).max())
    for factor in (2.0**-200, 2.0**100):  # powers of two change no digit
        scaled_value, scaled = energy.value_and_derivative(curve.with_vertices(factor * curve.vertices))
        assert scaled_value == value
        np.testing.assert_array_equal(factor * scaled, derivative)


def test_many_vertices_lose_no_digits():
    def energy_and_slope(n, energy):
        """The energy and its derivative along one smooth field."""
        curve = Curve(torus_trefoil(n).vertices * [1.0, 1.3, 0.8])
        value, derivative = energy.value_and_derivative(curve)
        return value, float(np.sum(derivative * np.sin(curve.vertices[:, [1, 2, 0]])))

    coarse, fine = (np.array(energy_and_slope(n, MoebiusEnergy())) for n in (500, 1000))
    limit = fine + (fine - coarse) / 3.0  # the midpoint rule's error falls with 1/n²
    value, slope = energy_and_slope(40_000, HierarchicalMoebiusEnergy())
    assert value == pytest.approx(limit[0], rel=1e-6)
    assert slope == pytest.approx(limit[1], rel=1e-5), "what the order of the expansions promises, see `theta`"


def flat_trefoil():
    """A curve with strands nearer than the barrier allows, and with many blocks all the same."""
    curve = torus_trefoil(1200)
    return curve.with_vertices(curve.vertices * [1.0, 1.0, 0.01])


def test_leaving_out_is_exact_and_the_objective_that_of_the_default_energy():
    """As exact as the expansions: 10⁻⁶ of the energy, 10⁻⁵ of the derivative."""
    curve = flat_trefoil()
    pairs = replaced_pairs(curve)
    assert len(pairs[0])
    fast, slow = (energy.leaving_out(pairs).value(curve) for energy in (with_small_leaves(curve), MoebiusEnergy()))
    assert fast == pytest.approx(slow, rel=1e-6)
    value, derivative = Objective.of(with_small_leaves(curve)).value_and_derivative(curve)
    exact, exact_derivative = Objective().value_and_derivative(curve)
    assert value == pytest.approx(exact, rel=1e-6)
    np.testing.assert_allclose(derivative, exact_derivative, atol=1e-5 * np.abs(exact_derivative).max())


def test_a_frozen_list_stays_until_strands_come_near():
    curve = torus_trefoil(2000)
    frozen, fresh = HierarchicalMoebiusEnergy().frozen_at(curve), HierarchicalMoebiusEnergy()
    nearby, flat = (curve.with_vertices(curve.vertices * [1.0, 1.0, z]) for z in (0.95, 0.005))
    assert frozen.value(nearby) != fresh.value(nearby)
    assert frozen.value(nearby) == pytest.approx(MoebiusEnergy().value(nearby), rel=1e-6)
    assert frozen.value(flat) == fresh.value(flat)
    pairs = replaced_pairs(flat)
    assert len(pairs[0])
    exact = MoebiusEnergy(pairs).value(flat)
    assert frozen.leaving_out(pairs).value(flat) == pytest.approx(exact, rel=1e-6)
    ring = HierarchicalMoebiusEnergy().frozen_at(hopf_link(60))
    for other in (torus_trefoil(120), hopf_link(80)):
        assert ring.value(other) == HierarchicalMoebiusEnergy().value(other)


def test_densely_packed_strands_are_summed_pair_by_pair(monkeypatch):
    packed, loose = CURVES["tangle"], torus_trefoil(2000)
    pairs = packed.mesh.tails[:2], packed.mesh.tails[2:4]
    listed = HierarchicalMoebiusEnergy().value(loose)
    monkeypatch.undo()
    for fast, slow in (
        (HierarchicalMoebiusEnergy(), MoebiusEnergy()),
        (HierarchicalMoebiusEnergy(without=pairs), MoebiusEnergy(pairs)),
    ):
        assert fast.value(packed) == slow.value(packed)
        for one, other in zip(fast.value_and_derivative(packed), slow.value_and_derivative(packed), strict=True):
            np.testing.assert_array_equal(one, other)
    assert HierarchicalMoebiusEnergy().value(loose) == listed != MoebiusEnergy().value(loose)
