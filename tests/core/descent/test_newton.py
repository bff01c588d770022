"""The quadratic end: systems of second derivatives against dense algebra, and what it promises of energies at rest."""

from dataclasses import replace

import numpy as np
import pytest
from changed_moves import change
from dense_stability import POINTS, dense_modes, tangent_basis
from mobius_flow.core import RelaxOptions, Status, Task, minimize
from mobius_flow.core.descent.hessian import lagrangian_hessian, lagrangian_matrix
from mobius_flow.core.descent.line_searches import Armijo, FirstTrial
from mobius_flow.core.descent.second_order import Curvature, Newton
from mobius_flow.core.driver.moves.rest import Settle
from mobius_flow.core.knots import torus_knot
from mobius_flow.core.solve.saddle.indefinite import FactorisedHessian
from shapes import lattice_knot, torus_trefoil

EXACT = [name for name in POINTS if name != "hierarchical"]
FIXED = RelaxOptions(radius="none", vertices=80, mesh="fixed")


@pytest.mark.parametrize("name", EXACT)
def test_systems_are_those_of_dense_algebra(name: str) -> None:
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
def test_the_matrix_is_that_of_the_products(name: str) -> None:
    """On tangent vectors, block rows of barycenters among them."""
    point = POINTS[name]()
    hessian, matrix = lagrangian_hessian(point), lagrangian_matrix(point)
    np.testing.assert_allclose(matrix, matrix.T, atol=1e-9 * np.abs(matrix).max())
    for v in np.random.default_rng(29).normal(size=(3, *point.vertices.shape)):
        v = point.tangent_space.project(v)
        image = hessian(v)
        np.testing.assert_allclose((matrix @ v.ravel()).reshape(v.shape), image, atol=1e-10 * np.abs(image).max())


def test_the_shift_grows_where_steps_are_short(monkeypatch: pytest.MonkeyPatch) -> None:
    """Here steps are, as no vertex may move by more than a millionth; the Hessian is not assembled again."""
    curvature, shifts, shifted = Curvature(POINTS["saddle"]()), [], Curvature.shifted

    def noted(self: Curvature, shift: float) -> FactorisedHessian:
        shifts.append(shift)
        return shifted(self, shift)

    newton = Newton(search=Armijo(decrease=0.1, first=FirstTrial(max_displacement=1e-6)))
    inverse, _, shift = newton.definite(curvature, 1e-4)
    monkeypatch.setattr(Curvature, "shifted", noted)
    steps = list(newton.along(curvature, inverse, shift, 4, 0.0))
    assert len(steps) == 4
    assert all(step.size < newton.short for step in steps)
    np.testing.assert_allclose(shifts, shift * newton.factor ** np.arange(1, 5))


@pytest.mark.parametrize("pins", [(), (0, 1, 17)])
@pytest.mark.parametrize("points", [1, 2])
def test_energies_at_rest_are_exact_on_their_mesh(
    pins: tuple[int, ...], points: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Though gradients are those of the default tolerance a run to the last digits gains nothing more."""
    change(monkeypatch, Settle, gradient=1e-300)  # L-BFGS goes as far as it has to
    wanted = replace(FIXED, quadrature_points=points)
    found = minimize(Task(curve=lattice_knot("4_1"), pins=pins), wanted)
    sharp = replace(wanted, method="trust-region", tolerance=1e-9, edge_lengths="keep")
    exact = minimize(Task(curve=found.curve, pins=found.last.pins), sharp)
    assert found.status is exact.status is Status.CONVERGED
    assert abs(found.energies[-1] - exact.energies[-1]) < 1e-8 * exact.energies[-1]


def test_the_index_comes_with_the_end() -> None:
    """Symmetric torus knots rest at saddles."""
    for p, q, index in ((2, 3, 0), (3, 4, 2)):
        result = minimize(torus_knot(p, q, 160), replace(FIXED, vertices=160))
        assert result.outcome.negative_eigenvalues == index
        assert ("saddle" in result.message) == (index > 0)


def test_second_derivatives_take_over_from_gradients(monkeypatch: pytest.MonkeyPatch) -> None:
    """Along the valleys of Möbius maps L-BFGS takes several times as many steps in the metric."""
    sharp = replace(FIXED, tolerance=1e-7)
    few = minimize(lattice_knot("4_1"), sharp)
    change(monkeypatch, Settle, gradient=1e-300)
    many = minimize(lattice_knot("4_1"), sharp)
    assert few.outcome.converged
    assert few.certified
    assert few.energies[-1] == pytest.approx(many.energies[-1], rel=1e-9)
    assert len(few.energies) < 0.7 * len(many.energies)


def test_where_steps_gain_little_gradients_end_the_run(monkeypatch: pytest.MonkeyPatch) -> None:
    """As in a curved valley; here since vertices may hardly move."""
    assembled: set[Curvature] = set()
    definite = Newton.definite
    short = Newton(search=Armijo(decrease=0.1, first=FirstTrial(max_displacement=3e-5)))

    def noted(self: Newton, curvature: Curvature, shift: float) -> tuple[FactorisedHessian, int, float]:
        assembled.add(curvature)
        return definite(self, curvature, shift)

    monkeypatch.setattr(Newton, "definite", noted)
    change(monkeypatch, Settle, newton=short)
    result = minimize(lattice_knot("4_1"), FIXED)
    assert result.status is Status.CONVERGED
    assert 3 <= len(assembled) < 15


def test_loose_tolerances_ask_for_no_more_than_gradients() -> None:
    assert minimize(torus_trefoil(80), replace(FIXED, tolerance=1e-3)).outcome.negative_eigenvalues is None


def test_where_nothing_makes_it_definite_gradients_end_the_run(monkeypatch: pytest.MonkeyPatch) -> None:
    point = POINTS[EXACT[0]]()
    monkeypatch.setattr(FactorisedHessian, "negative", 1)
    with pytest.raises(np.linalg.LinAlgError, match="no multiple of the metric"):
        Newton().definite(Curvature(point), 1e-3)
    result = minimize(torus_trefoil(40), FIXED)
    assert result.status is Status.CONVERGED
    assert result.outcome.negative_eigenvalues is None
