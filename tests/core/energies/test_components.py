"""What components add to the Möbius energy, and the energy of arcs: O'Hara's integral, 0 on straight segments only."""

import numpy as np
import pytest
from mobius_flow.core import Curve, Mesh, MoebiusEnergy
from mobius_flow.core.energies.components import ComponentShares
from shapes import half_circle, hopf_link, opened, straight_arc
from smooth_curves import random_polygon
from taylor import taylor_slope

CURVES = {
    "one edge": straight_arc(1),
    "arcs": opened(random_polygon(5, (3, 4, 5), 3), 0, 2),
    "plane": opened(random_polygon(5, (6,), 2), 0),
    "closed": random_polygon(5, (3, 4), 3),
}


@pytest.mark.parametrize("name", CURVES)
def test_derivatives(name):
    curve, shares = CURVES[name], ComponentShares(CURVES[name])
    v = np.random.default_rng(11).normal(size=curve.vertices.shape)
    product = shares.second_derivative(v)
    slope, curvature = np.sum(shares.derivative() * v), np.sum(product * v)
    if name in ("arcs", "plane"):
        for terms in ([shares.value(), slope], [shares.value(), slope, curvature]):
            order = taylor_slope(
                lambda t: ComponentShares(curve.with_vertices(curve.vertices + t * v)).value(), terms, largest=0.05
            )
            assert order == pytest.approx(len(terms), abs=0.05)
    else:  # single edges and closed components add constants
        np.testing.assert_allclose(shares.derivative(), 0.0, atol=1e-15)
    columns, found = shares.hessian_columns()
    hessian = np.zeros((curve.vertices.size, curve.vertices.size))
    hessian[:, columns] = found
    np.testing.assert_allclose(hessian, hessian.T, atol=1e-14)
    np.testing.assert_allclose((hessian @ v.ravel()).reshape(v.shape), product, atol=1e-12)


def test_shares():
    assert ComponentShares(hopf_link(9)).value() == 2.0
    arc = half_circle(60)
    share = ComponentShares(arc).value()
    assert share == pytest.approx(0.5 * np.log(arc.length / 2))
    assert ComponentShares(straight_arc(7)).value() == pytest.approx(0.0, abs=1e-15)
    # Ishizeki and Nagasawa's density vanishes on circles: it alone would not make arcs straight
    assert MoebiusEnergy().value(arc) == pytest.approx(4 * share, abs=1e-12)


def o_hara(curve_at, length):
    """∬ (1/r² − 1/ϱ²) of an arc that is parametrised by [0, 1] with constant speed, by Gauss points on a triangle."""
    points, weights = np.polynomial.legendre.leggauss(80)
    points, weights = 0.5 * (points + 1), 0.5 * weights
    total = 0.0
    for x, omega_x in zip(points, weights, strict=True):
        for u, omega_u in zip(points, weights, strict=True):
            chord = curve_at(x) - curve_at(x * u)
            total += omega_x * omega_u * x * (1 / (chord @ chord) - 1 / (length * x * (1 - u)) ** 2)
    return float(2 * length**2 * total)


ANGLE, PITCH = 2.0 * np.pi, 0.7
SMOOTH = {
    "half circle": (lambda s: np.array([np.cos(np.pi * s), np.sin(np.pi * s)]), np.pi),
    "helix": (
        lambda s: np.array([np.cos(ANGLE * s), np.sin(ANGLE * s), PITCH * ANGLE * s]),
        float(ANGLE * np.hypot(1.0, PITCH)),
    ),
}


@pytest.mark.parametrize("name", SMOOTH)
def test_energy_and_derivative_of_arcs_converge(name):
    """To O'Hara's integral; differences between meshes of the derivative along a smooth field fall by four each."""
    curve_at, length = SMOOTH[name]
    expected, counts, errors, slopes = o_hara(curve_at, length), [50, 100, 200, 400], [], []
    for n in counts:
        s = np.arange(n + 1) / n
        curve = Curve([curve_at(each) for each in s], Mesh((n + 1,), (False,)))
        field = np.zeros_like(curve.vertices)
        field[:, 0], field[:, 1] = s**2, np.cos(2 * s)
        value, derivative = MoebiusEnergy().value_and_derivative(curve)
        errors.append(abs(value - expected))
        slopes.append(np.sum(derivative * field))
    assert -np.polyfit(np.log(counts[:3]), np.log(errors[:3]), 1)[0] > 1.8
    assert errors[-1] < 5e-5 * expected
    change = np.abs(np.diff(slopes))
    assert np.all(np.log2(change[:-1] / change[1:]) > 1.8)
