"""The energy of Fourier curves: known values, derivatives, and how fast its quadrature converges."""

import numpy as np
import pytest
from mobius_flow.core.energies import MoebiusEnergy
from mobius_flow.lab.smooth.energy import Basis, SampledPairs, parameters, sliding
from mobius_flow.lab.smooth.fourier import FourierCurve
from mobius_flow.lab.smooth.rest import energy_of
from shapes import torus_trefoil
from taylor import taylor_slope


def random_link(rng):
    """A basis, a link of two components some way apart, and a direction."""
    basis = Basis.of([5, 3], 9)
    z = rng.normal(size=(len(basis.scale), 3))
    z[11] += 8.0  # where the second component's centre is
    return basis, z, rng.normal(size=z.shape)


def circles(*centres):
    """Unit circles, parallel to the planes of x and y and of x and z in turn."""
    parts = []
    for k, centre in enumerate(centres):
        axes = np.eye(3)[[0, 1 + k % 2]]
        parts.append(np.stack([np.array(centre) + 0j, axes[0] - 1j * axes[1], np.zeros(3)]))
    return FourierCurve(tuple(parts))


def test_a_circle_and_the_hopf_link_of_circles():
    assert energy_of(circles((0, 0, 0)), 8) == pytest.approx(4.0, abs=1e-12)
    assert energy_of(circles((0, 0, 0), (1, 0, 0)), 40) == pytest.approx(8.0 + 2.0 * linked_circles(), rel=1e-9)


def linked_circles():
    """∬ 1/|x − y|² of two circles, by brute force."""
    t = 2.0 * np.pi * np.arange(400) / 400
    x = np.stack([np.cos(t), np.sin(t), 0 * t], axis=1)
    y = np.stack([1.0 + np.cos(t), 0 * t, np.sin(t)], axis=1)
    return float((2.0 * np.pi / 400) ** 2 * np.sum(1.0 / np.sum((x[:, None] - y) ** 2, axis=2)))


def test_it_is_what_the_energies_of_polygons_tend_to():
    polygon = torus_trefoil(400)
    curve = FourierCurve.of(polygon, parameters(polygon), [20])
    values = [MoebiusEnergy().value(curve.polygon([n])) for n in (400, 800)]
    assert energy_of(curve, 8) == pytest.approx((4.0 * values[1] - values[0]) / 3.0, rel=1e-6)


def test_the_trapezoidal_rule_converges_geometrically():
    polygon = torus_trefoil(400)
    curve = FourierCurve.of(polygon, parameters(polygon), [12])
    exact = energy_of(curve, 16)
    errors = [abs(energy_of(curve, points) - exact) for points in (2, 3, 4)]
    assert errors[1] < 0.05 * errors[0]
    assert errors[2] < 0.05 * errors[1]


def test_derivatives():
    basis, z, u = random_link(np.random.default_rng(1))
    pairs = SampledPairs.of(basis, z)
    first, second = np.sum(pairs.gradient * u), u.ravel() @ pairs.hessian @ u.ravel()

    def along(t):
        return SampledPairs.of(basis, z + t * u).energy

    assert taylor_slope(along, [pairs.energy, first], 1e-2) == pytest.approx(2.0, abs=0.1)
    assert taylor_slope(along, [pairs.energy, first, second], 1e-2) == pytest.approx(3.0, abs=0.1)
    np.testing.assert_allclose(pairs.hessian, pairs.hessian.T, rtol=0, atol=1e-9 * np.abs(pairs.hessian).max())


def test_sliding_is_what_changes_speeds():
    """The form against differences: of logarithms of speeds over their components' averages."""
    basis, z, u = random_link(np.random.default_rng(2))

    def excess(t):
        logarithms = np.log(np.linalg.norm(basis.slopes @ (z + t * u), axis=1))
        return logarithms - basis.averages(logarithms)

    change = (excess(1e-6) - excess(-1e-6)) / 2e-6
    form = sliding(basis, z)
    assert u.ravel() @ form @ u.ravel() == pytest.approx(np.sum(basis.weights * change**2), rel=1e-6)
    assert np.abs(form @ z.ravel()).max() < 1e-9 * np.abs(form).max()  # speeds in proportion are no sliding
