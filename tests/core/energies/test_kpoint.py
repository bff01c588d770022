"""Energies by quadrature of a density: orders of rules, the arc distance's derivative, energies of one's own."""

import numpy as np
import pytest
from dense_stability import tangent_basis
from descent_contracts import point_on
from mobius_flow.core import Curve
from mobius_flow.core.base.errors import OptionError
from mobius_flow.core.descent.hessian import lagrangian_hessian
from mobius_flow.core.energies import Rule, moebius_kpoint
from mobius_flow.core.energies.barrier import exact
from mobius_flow.core.energies.density import TangentPointDensity
from mobius_flow.core.energies.edge_pairs import EdgePairs
from mobius_flow.core.energies.kpoint import EDGE_ENERGY, VERTEX_ENERGY
from shapes import hopf_link, regular_polygon
from smooth_curves import random_polygon
from taylor import derivative_slope

ARC = pytest.mark.parametrize("energy", [VERTEX_ENERGY, EDGE_ENERGY], ids=lambda each: each.name)


def quadrature_error(points, size, seed):
    """Relative error of Σ W_IJ between two triangles, ``size`` large and about 2 apart, against ∬ F."""
    first, second = size * np.random.default_rng(seed).normal(size=(2, 3, 3))
    curve = Curve.from_components([first, second + np.array([2.0, 0.5, 0.3])])
    rows, columns = (np.ravel(index) for index in np.meshgrid([0, 1, 2], [3, 4, 5]))
    reference = 2 * float(exact(EdgePairs.of(curve.mesh, curve.vertices, rows, columns)).value.sum())
    return abs(moebius_kpoint(points).value(curve) - 8 - reference) / reference


@pytest.mark.parametrize("points", [1, 2, 3])
def test_order_of_the_rule_on_far_pairs(points):
    """W_IJ → ∬ F at the order 2k of the k-point rule as edges shrink."""
    sizes = [0.2, 0.1, 0.05]
    errors = [np.mean([quadrature_error(points, size, seed) for seed in range(12)]) for size in sizes]
    assert np.polyfit(np.log(sizes), np.log(errors), 1)[0] == pytest.approx(2 * points, abs=0.15)


@ARC
@pytest.mark.parametrize("sizes", [(12,), (5, 8)])
def test_the_derivative_has_that_of_arcs(energy, sizes):
    curve = random_polygon(7, sizes, 3)
    v = np.random.default_rng(3).normal(size=curve.vertices.shape)
    assert derivative_slope(energy, curve, v, largest=1e-3) == pytest.approx(2, abs=0.01)


@ARC
def test_second_derivatives_along_the_constraints_are_symmetric_where_arcs_are_equally_long(energy):
    for curve in (random_polygon(7, (12,), 3), regular_polygon(12), hopf_link(10)):
        point = point_on(curve, energy=energy)
        basis = tangent_basis(point.tangent_space.constraints)
        columns = [lagrangian_hessian(point)(b.reshape(curve.vertices.shape)).ravel() for b in basis.T]
        full = basis.T @ np.array(columns).T
        np.testing.assert_allclose(full, full.T, rtol=0, atol=1e-11 * np.abs(full).max())


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
def test_options_are_checked(make, message):
    assert callable(make)
    with pytest.raises(OptionError, match=message):
        make()
