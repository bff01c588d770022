"""Fourier series of curves, and their energy and its derivatives."""

import json

import numpy as np
import pytest
from mobius_flow.core.energies import MoebiusEnergy
from mobius_flow.core.knots.inscribed import arc_steps
from mobius_flow.lab.smooth.energy import Basis, SampledPairs, parameters, sliding
from mobius_flow.lab.smooth.fourier import FourierCurve
from mobius_flow.lab.smooth.rest import energy_of
from shapes import hopf_link, torus_trefoil
from taylor import taylor_slope


def fitted():
    link = hopf_link(50)
    return FourierCurve.of(link, parameters(link), [7, 5])


def test_fits_visit_the_vertices():
    polygon = torus_trefoil(200)
    (at,) = parameters(polygon)
    curve = FourierCurve.of(polygon, [at], [40])
    waves = np.exp(2j * np.pi * np.outer(at, np.arange(41)))
    np.testing.assert_allclose((waves @ curve.coefficients[0]).real, polygon.vertices, rtol=0, atol=1e-5)


def test_unknowns_are_another_way_to_write_coefficients():
    curve = fitted()
    basis = Basis.of(curve.modes, 6)
    z = basis.unknowns(curve)
    for c, again in zip(curve.coefficients, basis.curve(z).coefficients, strict=True):
        np.testing.assert_allclose(again[1:], c[1:], rtol=0, atol=1e-15)
    np.testing.assert_allclose(basis.values @ z, curve.polygon([42, 30]).vertices, rtol=0, atol=1e-13)
    np.testing.assert_allclose(basis.unknowns_of(basis.values @ z), z, rtol=0, atol=1e-11)


def test_slopes_are_derivatives():
    curve = fitted()
    basis = Basis.of(curve.modes, 60)
    z = basis.unknowns(curve)
    for k, n in enumerate((420, 300)):
        own = basis.component == k
        x, v = (basis.values @ z)[own], (basis.slopes @ z)[own]
        difference = 0.5 * n * (np.roll(x, -1, axis=0) - np.roll(x, 1, axis=0))
        assert np.abs(v - difference).max() < 0.01 * np.abs(v).max()


def test_curves_as_json():
    curve = fitted()
    again = FourierCurve.of_lists(json.loads(json.dumps(curve.as_lists)))
    assert all(map(np.array_equal, curve.coefficients, again.coefficients))


def test_parameters_are_those_of_moebius_images_too():
    polygon = torus_trefoil(400)
    x = polygon.vertices - [2.5, 0.0, 0.3]
    image = polygon.with_vertices(x / np.sum(x**2, axis=1, keepdims=True))
    own, other = (parameters(curve)[0] for curve in (polygon, image))
    by_length, elsewhere = (arc_steps(curve.vertices) for curve in (polygon, image))
    assert np.abs(own - other).max() < 0.1 * np.abs(by_length - elsewhere).max()


def test_more_modes_do_not_change_the_curve():
    curve = fitted()
    np.testing.assert_allclose(
        curve.with_modes([9, 9]).polygon([20, 20]).vertices, curve.polygon([20, 20]).vertices, rtol=0, atol=1e-14
    )
    assert curve.with_modes([9, 9]).with_modes([7, 5]).modes == curve.modes


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
