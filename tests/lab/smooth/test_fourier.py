"""Fourier curves and their unknowns."""

import json

import numpy as np
from mobius_flow.core.knots.inscribed import arc_steps
from mobius_flow.lab.smooth.energy import Basis, parameters
from mobius_flow.lab.smooth.fourier import FourierCurve
from shapes import hopf_link, torus_trefoil


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
