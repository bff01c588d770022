"""Newton's method and soft modes, against dense algebra."""

from dataclasses import replace

import numpy as np
import pytest
from changed_moves import change
from dense_stability import POINTS, at, dense_modes, saddle, tangent_basis
from families import crossed
from mobius_flow.core import RelaxOptions, Status, Task, minimize
from mobius_flow.core.base.tolerances import BULK
from mobius_flow.core.descent.hessian import lagrangian_hessian, lagrangian_matrix, smooth_starts, soft_modes
from mobius_flow.core.descent.line_searches import Armijo, FirstTrial
from mobius_flow.core.descent.second_order import Curvature, Newton
from mobius_flow.core.driver.moves import rest as stability_module
from mobius_flow.core.driver.moves.rest import Settle, stability
from mobius_flow.core.knots import torus_knot
from mobius_flow.core.solve.saddle.indefinite import FactorisedHessian
from shapes import lattice_knot, torus_trefoil

EXACT = [name for name in POINTS if name != "hierarchical"]
FIXED = RelaxOptions(radius="none", vertices=80, mesh="fixed")


@pytest.mark.parametrize("name", EXACT)
def test_systems_are_those_of_dense_algebra(name):
    """Solutions on a basis of the tangent space, and the number of eigenvalues below −σ, with arcs, links and pins."""
    point, shift = POINTS[name](), 0.3
    curvature = Curvature(point)
    force = np.random.default_rng(3).normal(size=point.vertices.shape)
    u = curvature.shifted(shift).solve(force)
    basis, n = tangent_basis(point.tangent_space.constraints), len(point.vertices)
    gram = point.tangent_space.apply(basis.reshape(n, -1)).reshape(basis.shape)
    reduced = basis.T @ (lagrangian_matrix(point) @ basis + shift * gram)
    expected = (basis @ np.linalg.solve(reduced, basis.T @ force.ravel())).reshape(u.shape)
    np.testing.assert_allclose(u, expected, atol=1e-8 * np.abs(expected).max())
    values = dense_modes(point)[0]
    for k in np.argsort(np.diff(values))[-2:]:  # between eigenvalues that are not multiple ones
        assert curvature.shifted(-0.5 * (values[k] + values[k + 1])).negative == k + 1


@pytest.mark.parametrize("name", EXACT)
def test_the_matrix_is_that_of_the_products(name):
    """On tangent vectors, block rows of barycenters among them."""
    point = POINTS[name]()
    hessian, matrix = lagrangian_hessian(point), lagrangian_matrix(point)
    np.testing.assert_allclose(matrix, matrix.T, atol=1e-9 * np.abs(matrix).max())
    for v in np.random.default_rng(29).normal(size=(3, *point.vertices.shape)):
        v = point.tangent_space.project(v)
        image = hessian(v)
        np.testing.assert_allclose((matrix @ v.ravel()).reshape(v.shape), image, atol=1e-10 * np.abs(image).max())


def test_the_shift_grows_where_steps_are_short(monkeypatch):
    """Here steps are, as no vertex may move by more than a millionth; the Hessian is not assembled again."""
    curvature, shifts, shifted = Curvature(POINTS["saddle"]()), [], Curvature.shifted

    def noted(self, shift):
        shifts.append(shift)
        return shifted(self, shift)

    newton = Newton(search=Armijo(decrease=0.1, first=FirstTrial(max_displacement=1e-6)))
    inverse, _, shift = newton.definite(curvature, 1e-4)
    monkeypatch.setattr(Curvature, "shifted", noted)
    steps = list(newton.along(curvature, inverse, shift, 4, 0.0))
    assert len(steps) == 4
    assert all(step.size < newton.short for step in steps)
    np.testing.assert_allclose(shifts, shift * newton.factor ** np.arange(1, 5))


@pytest.mark.parametrize(("pins", "points"), crossed([(), (0, 1, 17)], [1, 2]))
def test_energies_at_rest_are_exact_on_their_mesh(pins, points, monkeypatch):
    """Though gradients are those of the default tolerance a run to the last digits gains nothing more."""
    change(monkeypatch, Settle, gradient=1e-300)  # L-BFGS goes as far as it has to
    wanted = replace(FIXED, quadrature_points=points)
    found = minimize(Task(curve=lattice_knot("4_1"), pins=pins), wanted)
    sharp = replace(wanted, method="trust-region", tolerance=1e-9, edge_lengths="keep")
    exact = minimize(Task(curve=found.curve, pins=found.last.pins), sharp)
    assert found.status is exact.status is Status.CONVERGED
    assert abs(found.energies[-1] - exact.energies[-1]) < 1e-8 * exact.energies[-1]


def test_the_index_comes_with_the_end():
    """Symmetric torus knots rest at saddles."""
    for p, q, index in ((2, 3, 0), (3, 4, 2)):
        result = minimize(torus_knot(p, q, 160), replace(FIXED, vertices=160))
        assert result.outcome.negative_eigenvalues == index
        assert ("saddle" in result.message) == (index > 0)


def test_second_derivatives_take_over_from_gradients(monkeypatch):
    """Along the valleys of Möbius maps L-BFGS takes several times as many steps in the metric."""
    sharp = replace(FIXED, tolerance=1e-7)
    few = minimize(lattice_knot("4_1"), sharp)
    change(monkeypatch, Settle, gradient=1e-300)
    many = minimize(lattice_knot("4_1"), sharp)
    assert few.outcome.converged
    assert few.certified
    assert few.energies[-1] == pytest.approx(many.energies[-1], rel=1e-9)
    assert len(few.energies) < 0.7 * len(many.energies)


def test_where_steps_gain_little_gradients_end_the_run(monkeypatch):
    """As in a curved valley; here since vertices may hardly move."""
    assembled = set()
    definite = Newton.definite
    short = Newton(search=Armijo(decrease=0.1, first=FirstTrial(max_displacement=3e-5)))

    def noted(self, curvature, shift):
        assembled.add(curvature)
        return definite(self, curvature, shift)

    monkeypatch.setattr(Newton, "definite", noted)
    change(monkeypatch, Settle, newton=short)
    result = minimize(lattice_knot("4_1"), FIXED)
    assert result.status is Status.CONVERGED
    assert 3 <= len(assembled) < 15


def test_loose_tolerances_ask_for_no_more_than_gradients():
    assert minimize(torus_trefoil(80), replace(FIXED, tolerance=1e-3)).outcome.negative_eigenvalues is None


def test_where_nothing_makes_it_definite_gradients_end_the_run(monkeypatch):
    point = POINTS[EXACT[0]]()
    monkeypatch.setattr(FactorisedHessian, "negative", 1)
    with pytest.raises(np.linalg.LinAlgError, match="no multiple of the metric"):
        Newton().definite(Curvature(point), 1e-3)
    result = minimize(torus_trefoil(40), FIXED)
    assert result.status is Status.CONVERGED
    assert result.outcome.negative_eigenvalues is None


def starts(point):
    return smooth_starts(point, np.random.default_rng(5))


@pytest.mark.parametrize("name", POINTS)
def test_all_soft_modes_are_those_of_the_matrix(name):
    """Differences make the hierarchical products, to five digits; its metric is solved with to two."""
    point = POINTS[name]()
    expected, _ = dense_modes(point)
    found = soft_modes(point, starts(point))
    soft = max(1, np.count_nonzero(expected < BULK))
    assert np.count_nonzero(found.values[: len(found.residuals)] < BULK) == np.count_nonzero(expected < BULK)
    np.testing.assert_allclose(found.values[:soft], expected[:soft], atol=2e-5 if name == "hierarchical" else 1e-9)
    assert (found.residuals[:soft] <= 1e-6).all()


@pytest.mark.parametrize("factorised", [True, False])
@pytest.mark.parametrize("name", POINTS)
def test_the_index_is_that_of_the_matrix(name, factorised, monkeypatch):
    """Whether factors tell it or Ritz values."""
    if not factorised:
        monkeypatch.setattr(Curvature, "is_known", lambda point: False)
    point = POINTS[name]()
    found = stability(point)
    assert found.index == np.count_nonzero(dense_modes(point)[0] < -found.zero)


def test_soft_modes_are_tangent_orthonormal_and_end_at_pins():
    for point in (saddle(), POINTS["pins"]()):
        vectors = soft_modes(point, starts(point), most=32).vectors
        assert max(np.abs(point.tangent_space.constraints.apply(u)).max() for u in vectors) < 1e-9
        duals = np.stack([point.tangent_space.apply(u) for u in vectors])
        np.testing.assert_allclose(np.tensordot(vectors, duals, ((1, 2), (1, 2))), np.eye(len(vectors)), atol=1e-9)
        assert not vectors[:, point.problem.constraints.pins.vertices].any()


def test_a_few_products_find_the_ways_down_from_a_saddle():
    """Ritz values are above the eigenvalues in their places, and residuals bound how far one is."""
    expected, _ = dense_modes(saddle())
    found = soft_modes(saddle(), starts(saddle()), most=32)
    assert (found.values > expected[: len(found.values)] - 1e-10).all()
    assert (found.values[:2] < 0.0).all()
    looked_at = found.values[: len(found.residuals), None]
    assert (np.abs(looked_at - expected).min(axis=1) <= found.residuals + 1e-10).all()
    assert found.residuals.max() > 1e-3


def test_every_eigenvalue_is_found_if_that_is_asked_for():
    """Beyond the last one there are no more dimensions."""
    regular = torus_knot(3, 4, 24)
    point = at(regular.with_vertices(regular.vertices + np.random.default_rng(7).normal(0.0, 0.03, (24, 3))))
    expected, _ = dense_modes(point)
    found = soft_modes(point, starts(point), below=np.inf)
    np.testing.assert_allclose(found.values, expected, atol=1e-8)


def test_nothing_is_soft_where_nothing_can_move():
    held = at(torus_trefoil(12), pins=tuple(range(12)))
    assert len(soft_modes(held, starts(held)).values) == 0
    assert stability(held).index == 0


def test_what_is_not_near_enough_is_no_index(monkeypatch):
    """Where Ritz values tell the index, because the matrix is too large."""
    monkeypatch.setattr(Curvature, "is_known", lambda point: False)
    assert stability(saddle()).index is not None
    monkeypatch.setattr(stability_module, "soft_modes", lambda point, starts, _: soft_modes(point, starts, most=16))
    assert stability(saddle()).index is None
