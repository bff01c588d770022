"""The interior point that pulls ropes tight: contacts, forces, Newton's matrix, and splines."""

import numpy as np
import pytest
from mobius_flow.core import Curve
from mobius_flow.core.collision import thickness
from mobius_flow.core.energies.edge_pairs import EdgePairs
from mobius_flow.core.knots import knot
from mobius_flow.core.ropes.contacts import Contacts
from mobius_flow.core.ropes.interior_point import InteriorPoint
from mobius_flow.core.ropes.splines import cubic_splines
from scipy.linalg import eigvalsh
from taylor import taylor_slope

RING = np.exp(2j * np.pi * np.arange(60) / 60)
CIRCLE = np.stack([RING.real, RING.imag, 0 * RING.real], axis=1)
HOPF = Curve.from_components([CIRCLE, CIRCLE[:, [0, 2, 1]] + [1.0, 0.0, 0.0]])


@pytest.fixture(scope="module")
def loose():
    """A trefoil of thickness 1, a little off its symmetry."""
    rough = knot("3_1", 60)
    curve = rough.with_vertices(rough.vertices + 0.01 * np.random.default_rng(1).normal(size=(60, 3)))
    return curve.with_vertices(1.01 * curve.vertices / thickness(curve))


def test_contacts_have_first_and_second_derivatives(loose):
    contacts = Contacts.near(loose, 0.5)
    assert contacts.strands > 5
    rng, x = np.random.default_rng(2), loose.vertices
    v, (z, k) = rng.normal(size=x.shape), rng.random((2, len(contacts.i))) * (rng.random((2, len(contacts.i))) < 0.5)
    v /= 100.0 * np.abs(v).max()

    def jet(t):
        return contacts.jet(EdgePairs.of(loose.mesh, x + t * v, contacts.i, contacts.j))

    first = jet(0.0).first
    assert taylor_slope(lambda t: jet(t).value, [jet(0.0).value, contacts.along(first, v)]) >= 1.95
    outer, curved = contacts.second(x, first, z, k)
    second = -(curved @ v.ravel()).reshape(v.shape)
    slope = taylor_slope(lambda t: contacts.sum_of(jet(t).first, z), [contacts.sum_of(first, z), second])
    assert slope >= 1.95
    assert np.allclose(v.ravel() @ (outer @ v.ravel()), k @ contacts.along(first, v) ** 2)


def test_constraints_are_those_of_the_thickness(loose):
    for scale in (0.9, 1.0, 1.1):
        curve = loose.with_vertices(scale * loose.vertices)
        holds = (Contacts.near(curve, 0.1).values(curve.vertices) >= 0.0).all()
        assert holds == (thickness(curve) >= 1.0)


def test_forces_at_rest_balance_the_tension():
    """Σ ⟨∇c, x⟩ z is the length: the forces of a rope that is pulled tight do as much work as its tension."""
    curve = HOPF.with_vertices(2.2 * HOPF.vertices)
    point = InteriorPoint(curve, 1e-3, lambda vertices: True)
    assert sum(1 for _ in point.run(1e-6)) < 60
    assert point.gap <= 1e-6
    assert point.residual <= 1e-5
    x, contacts = point.curve.vertices, point.contacts
    first = contacts.jet(EdgePairs.of(curve.mesh, x, contacts.i, contacts.j)).first
    assert point.forces @ contacts.along(first, x) == pytest.approx(point.curve.length, rel=1e-4)
    assert 1.0 <= thickness(point.curve) < 1.00001
    assert point.curve.length == pytest.approx(8.0 * np.pi, rel=2e-3)  # of 60 vertices each


def test_forces_of_centred_ropes_are_the_slope_of_the_barrier(loose):
    point = InteriorPoint(loose, 0.1, lambda vertices: True)
    c, v = np.array([0.01, 0.2, 0.299, 0.31]), np.ones(4)  # near the wall, and on both sides of the margin
    first = [point._walls(c), -point._push(c) @ v]
    assert taylor_slope(lambda t: point._walls(c + 0.005 * t * v), [first[0], 0.005 * first[1]]) >= 1.9


def test_newton_counts_so_much_of_the_walls_curvature_as_leaves_its_matrix_definite(loose):
    point = InteriorPoint(loose, 0.1, lambda vertices: True)
    point.step()
    contacts, x = point.contacts, point.curve.vertices
    first = contacts.jet(EdgePairs.of(loose.mesh, x, contacts.i, contacts.j)).first
    stiff, curved = contacts.second(x, first, 0.1 * point.forces, point.forces)
    elastic = np.kron(point._elastic.toarray(), np.eye(3))
    ridge = 1e-6 * elastic.diagonal().mean() * np.eye(len(elastic))
    factor = point._factorised(stiff, curved)
    rest = stiff.toarray() + elastic + ridge + point._delta * (elastic + 1e4 * ridge)

    def least(share):
        return eigvalsh(rest + share * curved.toarray(), subset_by_index=[0, 0])[0]

    assert 0.0 < point._counted < 1.0
    assert least(point._counted) > 0.0 > least(1.0)
    right = np.random.default_rng(5).normal(size=x.size)
    np.testing.assert_allclose(rest @ (y := factor.solve(right)) + point._counted * (curved @ y), right, atol=1e-6)


def test_splines_have_controls_of_which_they_are_averages_and_halves_are_theirs():
    """Of equal points they are at these; twice as many vertices are at the same places, and others between."""
    basis, finer = (cubic_splines([8, 9], per) for per in (2, 4))
    assert np.allclose(basis.sum(axis=1), 1.0)
    assert abs(finer[::2] - basis).max() < 1e-15
    angles = 2.0 * np.pi * np.arange(9) / 9
    points = finer[32:, 8:] @ np.stack([np.cos(angles), np.sin(angles)], axis=1)
    assert np.ptp(np.linalg.norm(points, axis=1)) < 1e-3  # of a curve with two derivatives


def test_residuals_are_about_the_same_by_vertices_and_by_controls():
    basis = cubic_splines([60], 4)
    curve = Curve(basis @ knot("3_1", 60).vertices)
    curve = curve.with_vertices(1.01 * curve.vertices / thickness(curve))
    points = [InteriorPoint(curve, 0.01, lambda _: True, basis=each) for each in (None, basis)]
    for point in points:
        point.step()
    assert points[1].residual == pytest.approx(points[0].residual, rel=0.2)
