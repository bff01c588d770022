"""Rigid motions, scale, orientation, the choice of the first vertex; units and places people use."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mobius_flow.core import Curve, Objective
from mobius_flow.core.curve import Mesh
from mobius_flow.core.energies import ENERGIES, Barrier, Energy
from smooth_curves import SMOOTH_CURVES, random_polygon

ALL = {**ENERGIES, "objective": Objective(), "barrier": Barrier()}
ENERGY = pytest.mark.parametrize("energy", ALL.values(), ids=ALL)


def wound(seed: int, dimension: int = 3) -> Curve:
    """Two strands side by side, not smooth, some edges nearer to each other than they are long."""
    rng = np.random.default_rng(seed)
    t = 4 * np.pi * np.arange(24) / 24
    r = 1 + 0.12 * np.cos(1.5 * t)
    points = np.zeros((24, dimension))
    points[:, 0], points[:, 1], points[:, -1] = r * np.cos(t), r * np.sin(t), points[:, -1] + 0.15 * np.sin(1.5 * t)
    return Curve(points + 0.02 * rng.normal(size=points.shape))


def scale_exponent(energy: Energy) -> float:
    """Of the energy under scaling; the barrier has none of its own: its energy is dimensionless."""
    return getattr(energy, "scale_exponent", 0.0)


def is_one_sided(energy: Energy) -> bool:
    """Whether its points on an edge are others from the other end: then unequal edges tell orientations apart."""
    points = np.array(energy.rule.points) if hasattr(energy, "rule") else np.array([0.5])
    return not np.allclose(np.sort(points), np.sort(1.0 - points))


def test_exponents_and_sides() -> None:
    assert {name for name, energy in ALL.items() if scale_exponent(energy)} == {"tangent-point"}
    assert scale_exponent(ENERGIES["tangent-point"]) == -1.0
    assert {name for name, energy in ALL.items() if is_one_sided(energy)} == {"vertex"}


def rotation(seed: int, dimension: int) -> np.ndarray:
    return np.linalg.qr(np.random.default_rng(seed).normal(size=(dimension, dimension)))[0]


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_the_barrier_is_at_work_in_these_tests(seed: int) -> None:
    assert abs(Barrier().value(wound(seed))) > 1


@ENERGY
@given(seed=st.integers(0, 999), log_scale=st.floats(-9, 9))
@settings(max_examples=10, deadline=None)
def test_similarities(energy: Energy, seed: int, log_scale: float) -> None:
    curve, scale = wound(seed), 10.0**log_scale
    moved = curve.with_vertices(scale * (curve.vertices @ rotation(seed, 3) + [1.0, -2.0, 3.0]))
    value, derivative = energy.value_and_derivative(curve)
    moved_value, moved_derivative = energy.value_and_derivative(moved)
    factor = scale ** scale_exponent(energy)
    assert moved_value == pytest.approx(factor * value, rel=1e-9, abs=1e-9 * factor)
    expected = derivative @ rotation(seed, 3) * (factor / scale)
    np.testing.assert_allclose(moved_derivative, expected, rtol=0, atol=1e-7 * np.abs(expected).max())


@ENERGY
@pytest.mark.parametrize("scale", [1e-30, 1e-9, 1e9, 1e30])
def test_units(energy: Energy, scale: float) -> None:
    curve = wound(1)
    factor = scale ** scale_exponent(energy)
    value = energy.value(curve.with_vertices(scale * curve.vertices))
    assert value == pytest.approx(factor * energy.value(curve), rel=1e-11)


@ENERGY
def test_far_from_the_origin(energy: Energy) -> None:
    curve = SMOOTH_CURVES["trefoil"].polygon(60)
    far = curve.with_vertices(curve.vertices + np.array([1e6, -2e6, 3e6]))
    rounded = far.with_vertices(far.vertices - np.array([1e6, -2e6, 3e6]))  # what is left of the curve, exactly
    value, derivative = energy.value_and_derivative(rounded)
    far_value, far_derivative = energy.value_and_derivative(far)
    assert far_value == pytest.approx(value, rel=1e-9)
    np.testing.assert_allclose(far_derivative, derivative, rtol=0, atol=1e-8 * max(np.abs(derivative).max(), 1e-30))


@ENERGY
@given(seed=st.integers(0, 999), shift=st.integers(1, 23))
@settings(max_examples=10, deadline=None)
def test_the_first_vertex_does_not_matter(energy: Energy, seed: int, shift: int) -> None:
    curve = wound(seed)
    rolled = curve.with_vertices(np.roll(curve.vertices, shift, axis=0))
    value, derivative = energy.value_and_derivative(curve)
    rolled_value, rolled_derivative = energy.value_and_derivative(rolled)
    assert rolled_value == pytest.approx(value, rel=1e-11, abs=1e-11)
    scale = np.abs(derivative).max() + 1e-30
    np.testing.assert_allclose(rolled_derivative, np.roll(derivative, shift, axis=0), rtol=0, atol=1e-10 * scale)


@ENERGY
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_orientation(energy: Energy, seed: int) -> None:
    curve = wound(seed)
    turned = curve.with_vertices(curve.vertices[::-1])
    if is_one_sided(energy):
        assert energy.value(turned) != pytest.approx(energy.value(curve), rel=1e-6)
    else:
        assert energy.value(turned) == pytest.approx(energy.value(curve), rel=1e-12)


@ENERGY
def test_order_of_the_components(energy: Energy) -> None:
    link = random_polygon(5, (8, 5, 6), 3)
    parts = [link.components[k] for k in (2, 0, 1)]
    assert energy.value(Curve.from_components(parts)) == pytest.approx(energy.value(link), rel=1e-12)


@ENERGY
def test_the_space_may_have_more_dimensions(energy: Energy) -> None:
    curve = wound(7)
    lifted = Curve(np.hstack([curve.vertices, np.zeros((24, 2))]), Mesh((24,)))
    assert energy.value(lifted) == pytest.approx(energy.value(curve), rel=1e-12)
    assert not energy.value_and_derivative(lifted)[1][:, 3:].any()


@pytest.mark.parametrize("name", ["moebius", "moebius-k2"])
def test_sphere_inversions_in_the_limit(name: str) -> None:
    """Möbius transformations change the energy of polygons by O(N⁻²), that of more points by O(N⁻¹)."""
    differences = []
    for n in (200, 400):
        curve = SMOOTH_CURVES["trefoil"].polygon(n)
        from_centre = curve.vertices - np.array([6.0, 1.0, 2.0])
        inverted = curve.with_vertices(from_centre / np.sum(from_centre**2, axis=1)[:, None])
        differences.append(abs(ENERGIES[name].value(inverted) - ENERGIES[name].value(curve)))
    assert differences[1] < (0.3 if name == "moebius" else 0.6) * differences[0]
