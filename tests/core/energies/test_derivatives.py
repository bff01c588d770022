"""First and second derivatives of every energy, by Taylor slopes and against finite differences."""

import numpy as np
import pytest
from mobius_flow.core import Curve, MoebiusEnergy, Objective
from mobius_flow.core.energies import ENERGIES, Assembled, Barrier, Energy, TwiceDifferentiable, moebius_kpoint
from mobius_flow.core.energies.barrier import near_pairs
from mobius_flow.core.knots import knot
from shapes import lattice_knot, opened, regular_polygon
from smooth_curves import dual_circles, random_polygon
from taylor import derivative_slope, hessian_slope, taylor_slope

ENERGY = pytest.mark.parametrize("energy", [*ENERGIES.values(), moebius_kpoint(1)], ids=lambda e: e.name)
TWICE = pytest.mark.parametrize(
    "energy", [MoebiusEnergy(), Objective(), Objective(barrier=None)], ids=["moebius", "objective", "without barrier"]
)


def star(n: int) -> Curve:
    """A polygon of the plane that does not cross itself."""
    t, r = 2 * np.pi * np.arange(n) / n, np.random.default_rng(1).uniform(0.5, 1.5, n)
    return Curve(np.stack([r * np.cos(t), r * np.sin(t)], axis=1))


CURVES = {
    "plane": star(11),
    "knot": random_polygon(3, (13,), 3),
    "link": random_polygon(5, (3, 4, 5), 3),
    "fourfold": random_polygon(7, (6, 7), 4),
    "open": opened(random_polygon(5, (3, 4, 5), 3), 0, 2),
}
CURVE = pytest.mark.parametrize("curve", CURVES.values(), ids=CURVES)


def near_curve(gap: float = 0.05, n: int = 20) -> Curve:
    """Two crossing strands of one curve, nearer to each other than their edges are long."""
    t = 2 * np.pi * (np.arange(n) + 0.3) / n
    return Curve(np.stack([np.sin(t), np.sin(2 * t), 0.5 * gap * np.cos(t)], axis=1))


def direction_for(curve: Curve) -> np.ndarray:
    return np.random.default_rng(11).normal(size=curve.vertices.shape)


@ENERGY
@CURVE
def test_taylor_slope_of_the_derivative(energy: Energy, curve: Curve) -> None:
    assert derivative_slope(energy, curve, direction_for(curve), largest=1e-3) == pytest.approx(2, abs=0.01)


@ENERGY
def test_value_agrees_with_value_and_derivative(energy: Energy) -> None:
    curve = CURVES["link"]
    assert energy.value(curve) == pytest.approx(energy.value_and_derivative(curve)[0], rel=1e-14)


@pytest.mark.parametrize("gap", [0.3, 0.05, 1e-3, 1e-5])
def test_objective_near_contact(gap: float) -> None:
    curve = near_curve(gap)
    assert len(near_pairs(curve)[0]) > 0
    v = direction_for(curve)
    largest = min(1e-3, 0.02 * gap)
    assert derivative_slope(Objective(), curve, v, largest) == pytest.approx(2, abs=0.02)
    assert hessian_slope(Objective(), curve, v, largest) == pytest.approx(3, abs=0.05)


@pytest.mark.parametrize("curve", [lattice_knot("3_1"), knot("thistlethwaite")], ids=["lattice", "diagram"])
def test_objective_of_coarse_input(curve: Curve) -> None:
    v = direction_for(curve)
    assert derivative_slope(Objective(), curve, v, largest=0.01) == pytest.approx(2, abs=0.01)
    assert hessian_slope(Objective(), curve, v, largest=0.01) == pytest.approx(3, abs=0.02)


@pytest.mark.parametrize("energy", [*ENERGIES.values(), moebius_kpoint(1), Objective()], ids=lambda e: e.name)
@CURVE
def test_hessian_products_have_the_right_slopes(energy: TwiceDifferentiable, curve: Curve) -> None:
    v = direction_for(curve)
    assert hessian_slope(energy, curve, v, largest=1e-3) == pytest.approx(3, abs=0.02)

    def derivative(t: float) -> np.ndarray:
        return energy.value_and_derivative(curve.with_vertices(curve.vertices + t * v))[1]

    change = energy.hessian_product(curve, v)
    assert taylor_slope(derivative, [derivative(0.0), change], largest=1e-3) == pytest.approx(2, abs=0.02)


@TWICE
@CURVE
def test_hessian_is_symmetric(energy: Assembled, curve: Curve) -> None:
    matrix = energy.hessian(curve)
    rounding = 8 * curve.mesh.edges * np.finfo(float).eps  # an entry is a sum over the edges, added in either order
    np.testing.assert_allclose(matrix, matrix.T, rtol=0, atol=rounding * np.abs(matrix).max())


@TWICE
@pytest.mark.parametrize("curve", [*CURVES.values(), near_curve()], ids=[*CURVES, "near"])
def test_hessian_product_is_that_of_the_matrix(energy: Assembled, curve: Curve) -> None:
    v = direction_for(curve)
    matrix = energy.hessian(curve)
    product = energy.hessian_product(curve, v).ravel()
    np.testing.assert_allclose(product, matrix @ v.ravel(), rtol=0, atol=1e-12 * np.abs(product).max())


@TWICE
@pytest.mark.parametrize("curve", [CURVES["link"], near_curve()], ids=["link", "near"])
def test_hessian_against_finite_differences(energy: Assembled, curve: Curve) -> None:
    matrix, step = energy.hessian(curve), 1e-6
    differences = np.empty_like(matrix)
    for k in range(len(matrix)):
        shift = np.zeros(len(matrix))
        shift[k] = step
        ends = [curve.vertices + sign * shift.reshape(curve.vertices.shape) for sign in (1, -1)]
        plus, minus = (energy.value_and_derivative(curve.with_vertices(end))[1].ravel() for end in ends)
        differences[k] = (plus - minus) / (2 * step)
    np.testing.assert_allclose(matrix, differences, rtol=0, atol=1e-6 * np.abs(matrix).max())


def test_several_tiles() -> None:
    curve = dual_circles(150)
    v = direction_for(curve)
    matrix = MoebiusEnergy().hessian(curve)
    product = MoebiusEnergy().hessian_product(curve, v).ravel()
    np.testing.assert_allclose(matrix @ v.ravel(), product, rtol=0, atol=1e-12 * np.abs(product).max())
    assert hessian_slope(MoebiusEnergy(), curve, v, largest=1e-3) == pytest.approx(3, abs=0.05)


def test_barrier_hessian_is_zero_without_near_pairs() -> None:
    curve = regular_polygon(40)
    assert not Barrier().sparse_hessian(curve).nnz
    assert not Barrier().hessian_product(curve, direction_for(curve)).any()
    assert Barrier().value_and_derivative(curve)[0] == 0.0


def test_translations_and_rotations_are_in_the_kernel_of_the_hessian_at_a_critical_point() -> None:
    curve = regular_polygon(24)
    matrix = MoebiusEnergy().hessian(curve)
    assert np.abs(MoebiusEnergy().value_and_derivative(curve)[1]).max() < 1e-12
    spin = np.stack([-curve.vertices[:, 1], curve.vertices[:, 0], np.zeros(24)], axis=1)
    for motion in (np.tile([1.0, 2.0, 3.0], (24, 1)), spin, curve.vertices):
        assert np.abs(matrix @ motion.ravel()).max() < 1e-11 * np.abs(matrix).max()
