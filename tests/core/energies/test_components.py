"""What components add to the Möbius energy, and the energy of arcs: O'Hara's integral, 0 on straight segments only."""

import numpy as np
import pytest
from mobius_flow.core import Curve, Mesh, MoebiusEnergy
from mobius_flow.core.energies import ENERGIES
from mobius_flow.core.energies.components import ComponentShares
from shapes import half_circle, hopf_link, opened, regular_polygon, straight_arc
from smooth_curves import random_polygon
from taylor import taylor_slope

CURVES = {
    "one edge": straight_arc(1),
    "arcs": opened(random_polygon(5, (3, 4, 5), 3), 0, 2),
    "plane": opened(random_polygon(5, (6,), 2), 0),
    "closed": random_polygon(5, (3, 4), 3),
}
CURVE = pytest.mark.parametrize("curve", CURVES.values(), ids=CURVES)


def along(curve: Curve, t: float, v: np.ndarray) -> float:
    return ComponentShares(curve.with_vertices(curve.vertices + t * v)).value()


@pytest.mark.parametrize("name", ["arcs", "plane"])
def test_slopes_of_derivatives(name: str) -> None:
    curve = CURVES[name]
    v = np.random.default_rng(11).normal(size=curve.vertices.shape)
    shares = ComponentShares(curve)
    slope, curvature = np.sum(shares.derivative() * v), np.sum(shares.second_derivative(v) * v)
    for terms in ([shares.value(), slope], [shares.value(), slope, curvature]):
        order = taylor_slope(lambda t: along(curve, t, v), terms, largest=0.05)
        assert order == pytest.approx(len(terms), abs=0.05)


@pytest.mark.parametrize("name", ["one edge", "closed"])
def test_single_edges_and_closed_components_add_constants(name: str) -> None:
    np.testing.assert_allclose(ComponentShares(CURVES[name]).derivative(), 0.0, atol=1e-15)


@CURVE
def test_columns_of_the_hessian(curve: Curve) -> None:
    columns, found = ComponentShares(curve).hessian_columns()
    hessian = np.zeros((curve.vertices.size, curve.vertices.size))
    hessian[:, columns] = found
    np.testing.assert_allclose(hessian, hessian.T, atol=1e-14)
    v = np.random.default_rng(13).normal(size=curve.vertices.shape)
    product = ComponentShares(curve).second_derivative(v)
    np.testing.assert_allclose((hessian @ v.ravel()).reshape(v.shape), product, atol=1e-12)


def test_shares() -> None:
    assert ComponentShares(hopf_link(9)).value() == 2.0
    arc = half_circle(50)
    assert ComponentShares(arc).value() == pytest.approx(0.5 * np.log(arc.length / 2))
    assert ComponentShares(straight_arc(7)).value() == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize("name", ["moebius", "vertex", "edge", "moebius-k2", "moebius-k3", "tangent-point"])
def test_straight_segments_have_no_energy(name: str) -> None:
    assert ENERGIES[name].value(straight_arc(40)) == pytest.approx(0.0, abs=1e-12)


def o_hara(curve_at, length: float) -> float:
    """∬ (1/r² − 1/ϱ²) of an arc that is parametrised by [0, 1] with constant speed, by Gauss points on a triangle."""
    points, weights = np.polynomial.legendre.leggauss(80)
    points, weights = 0.5 * (points + 1), 0.5 * weights
    total = 0.0
    for x, omega_x in zip(points, weights, strict=True):
        for u, omega_u in zip(points, weights, strict=True):
            chord = curve_at(x) - curve_at(x * u)
            total += omega_x * omega_u * x * (1 / (chord @ chord) - 1 / (length * x * (1 - u)) ** 2)
    return float(2 * length**2 * total)


HELIX = 2.0 * np.pi, 0.7  # angle and pitch


def helix(s: float) -> np.ndarray:
    angle, pitch = HELIX
    return np.array([np.cos(angle * s), np.sin(angle * s), pitch * angle * s])


SMOOTH = {
    "half circle": (lambda s: np.array([np.cos(np.pi * s), np.sin(np.pi * s)]), np.pi),
    "helix": (helix, float(HELIX[0] * np.hypot(1.0, HELIX[1]))),
}


def polygon(curve_at, edges: int) -> Curve:
    return Curve([curve_at(k / edges) for k in range(edges + 1)], Mesh((edges + 1,), (False,)))


@pytest.mark.parametrize("name", SMOOTH)
def test_energy_of_arcs_converges_to_o_haras_integral(name: str) -> None:
    curve_at, length = SMOOTH[name]
    expected = o_hara(curve_at, length)
    counts = [50, 100, 200, 400]
    errors = [abs(MoebiusEnergy().value(polygon(curve_at, n)) - expected) for n in counts]
    assert -np.polyfit(np.log(counts[:3]), np.log(errors[:3]), 1)[0] > 1.8
    assert errors[-1] < 5e-5 * expected


@pytest.mark.parametrize("name", SMOOTH)
def test_derivative_of_arcs_converges(name: str) -> None:
    """Along a smooth field; differences between meshes fall by four with each halving."""
    curve_at, _ = SMOOTH[name]
    slopes = []
    for n in (50, 100, 200, 400):
        curve = polygon(curve_at, n)
        s = np.arange(n + 1) / n
        field = np.zeros_like(curve.vertices)
        field[:, 0], field[:, 1] = s**2, np.cos(2 * s)
        slopes.append(np.sum(MoebiusEnergy().value_and_derivative(curve)[1] * field))
    change = np.abs(np.diff(slopes))
    assert np.log2(change[0] / change[1]) > 1.8
    assert np.log2(change[1] / change[2]) > 1.8


def test_circular_arcs_have_the_logarithm_alone() -> None:
    """Ishizeki and Nagasawa's density vanishes on circles: it alone would not make arcs straight."""
    arc = half_circle(60)
    share = 4 * ComponentShares(arc).value()
    assert MoebiusEnergy().value(arc) == pytest.approx(share, abs=1e-12)
    assert share > 0.9


@pytest.mark.parametrize("name", ENERGIES)
def test_invariances(name: str) -> None:
    energy, arc = ENERGIES[name], opened(random_polygon(5, (12,), 3), 0)
    value = energy.value(arc)
    rotation = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    moved = arc.with_vertices(arc.vertices @ rotation.T + 5.0)
    assert energy.value(moved) == pytest.approx(value, rel=1e-10)
    scaled = arc.with_vertices(3.0 * arc.vertices)
    assert energy.value(scaled) == pytest.approx(3.0**energy.scale_exponent * value, rel=1e-12)
    if name != "vertex":  # which looks at the tails alone
        assert energy.value(arc.with_vertices(arc.vertices[::-1])) == pytest.approx(value, rel=1e-12)


def test_an_arc_through_a_ring() -> None:
    """Between components the density is 1/r², whether they are closed or not: the sum over the arc's pairs is less."""
    closed, arc = hopf_link(60), opened(hopf_link(60), 1)
    assert 4.0 < MoebiusEnergy().value(arc) - ComponentShares(arc).value() * 4 < MoebiusEnergy().value(closed) - 8.0
    assert MoebiusEnergy().value(regular_polygon(60)) == pytest.approx(4.0)
