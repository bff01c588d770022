"""Tangent spaces with pins: unknowns that there are none of, against the whole matrix of (41) with a row for each."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from families import crossed
from mobius_flow.core import Curve
from mobius_flow.core.base.types import FloatArray, IntArray
from mobius_flow.core.curve.pins import Pins, free_edges
from mobius_flow.core.solve.constraints import Barycenters, ConstraintDerivative, Constraints
from mobius_flow.core.solve.hierarchical import moebius_inner_product
from mobius_flow.core.solve.metrics import METRICS, DenseInnerProduct, SparseInnerProduct
from mobius_flow.core.solve.saddle.iterative import Tolerances
from mobius_flow.core.solve.saddle.models import PinnedModel
from mobius_flow.core.solve.saddle.tangent_space import euclidean_correction
from shapes import hopf_link, regular_polygon, torus_trefoil
from taylor import taylor_slope

EXACT = Tolerances(gradient=1e-11, correction=1e-11, preconditioner=1e-11, feasibility=1e-12)
INNER_PRODUCTS = {
    "moebius": METRICS["moebius"].at,
    "h1": METRICS["h1"].at,
    "compressed": lambda curve: moebius_inner_product(curve, EXACT),
}


def rough(curve: Curve) -> Curve:
    rng = np.random.default_rng(71)
    return curve.with_vertices(curve.vertices + 0.02 * rng.normal(size=curve.vertices.shape))


PINNED = {
    "one": (rough(torus_trefoil(60)), None, [17]),
    "the first": (rough(torus_trefoil(60)), None, [0]),
    "some": (rough(torus_trefoil(60)), None, [3, 20, 22, 41, 59]),
    "in a row": (rough(torus_trefoil(60)), None, [0, 1, 2, 3, 4, 5, 6, 30, 59]),
    "all but one": (rough(torus_trefoil(60)), None, list(range(1, 60))),
    "all": (rough(torus_trefoil(60)), None, list(range(60))),
    "link": (rough(hopf_link(20)), None, [25, 31]),
    "one part": (rough(hopf_link(20)), (1, 0), [4]),
    "plane": (rough(regular_polygon(30, dimension=2)), None, [0, 9, 19]),
    "4-space": (rough(regular_polygon(30, dimension=4)), None, [0, 9, 19]),
}
NAMES = pytest.mark.parametrize("name", PINNED)


def constraints_of(name: str) -> tuple[Curve, Constraints]:
    curve, parts, vertices = PINNED[name]
    pins = Pins.of(curve, np.array(vertices))
    return curve, Constraints(curve.edge_lengths, (Barycenters.of(curve, pins, parts),), pins)


def tangent_direction(curve: Curve, pins: IntArray) -> FloatArray:
    """A rough field that vanishes at pins."""
    u = np.random.default_rng(73).normal(size=curve.vertices.shape)
    u[pins] = 0.0
    return u


def columns(derivative: ConstraintDerivative) -> FloatArray:
    """DΦ as a matrix, with a column for every coordinate, pinned or not."""
    units = np.eye(int(np.prod(derivative.shape)))
    return np.stack([derivative.apply(unit.reshape(derivative.shape)) for unit in units], axis=1)


@NAMES
def test_derivative_with_pins_has_slope_two_and_an_adjoint(name: str) -> None:
    curve, constraints = constraints_of(name)
    derivative = constraints.derivative(curve)
    assert len(constraints.residual(curve)) == derivative.count
    u = 0.01 * tangent_direction(curve, constraints.pins.vertices)
    stretched = replace(constraints, lengths=1.1 * constraints.lengths)
    along = [stretched.residual(curve), derivative.apply(u)]
    if derivative.count:
        move = lambda t: stretched.residual(curve.with_vertices(curve.vertices + t * u))  # noqa: E731
        assert abs(taylor_slope(move, along, largest=1.0) - 2) < 0.1
    multipliers = np.random.default_rng(79).normal(size=derivative.count)
    assert derivative.apply(u) @ multipliers == pytest.approx(np.sum(u * derivative.apply_transpose(multipliers)))


@NAMES
def test_rows_have_full_rank_where_vertices_are_free(name: str) -> None:
    """So must lengths between pins leave, and barycenters of parts that are pinned."""
    curve, constraints = constraints_of(name)
    derivative = constraints.derivative(curve)
    m, pins = curve.dimension, constraints.pins.vertices
    free = np.setdiff1d(np.arange(len(curve)), pins)
    matrix = columns(derivative)[:, (m * free[:, None] + np.arange(m)).ravel()]
    assert derivative.count == len(free_edges(curve.mesh, pins)) + (m if name == "one part" else 0)
    if derivative.count:
        assert np.linalg.matrix_rank(matrix, tol=1e-8 * np.abs(matrix).max()) == derivative.count


@pytest.mark.parametrize(("name", "product"), crossed(PINNED, INNER_PRODUCTS))
def test_agrees_with_dense_lu_with_a_row_for_every_pinned_coordinate(name: str, product: str) -> None:
    """The whole matrix of (41), [J Cᵀ Eᵀ; C 0 0; E 0 0], E the rows P_v = P⁰_v."""
    curve, constraints = constraints_of(name)
    derivative, pins = constraints.derivative(curve), constraints.pins.vertices
    (n, m), count = curve.vertices.shape, derivative.count
    inner = INNER_PRODUCTS[product](curve)
    held = np.kron(np.eye(n)[pins], np.eye(m))
    rows = np.concatenate([columns(derivative), held])
    zero = np.zeros((len(rows), len(rows)))
    full = np.block([[np.kron(inner.dense(), np.eye(m)), rows.T], [rows, zero]])
    space = inner.tangent_space(derivative)
    rng = np.random.default_rng(83)
    eta, xi, v = rng.normal(size=(n, m)), rng.normal(size=count), tangent_direction(curve, pins)
    for right, below, (u, multipliers) in [
        (eta, np.zeros(count), space.gradient(eta)),
        (np.zeros((n, m)), xi, space.solve(None, xi)),
        (eta, xi, space.solve(eta, xi)),
        (inner.apply(v), np.zeros(count), (space.project(v), None)),
    ]:
        expected = np.linalg.solve(full, np.concatenate([right.ravel(), below, np.zeros(len(held))]))
        size = max(np.abs(expected[: n * m + count]).max(), 1e-6)
        np.testing.assert_allclose(u.ravel(), expected[: n * m], atol=1e-8 * size, rtol=0)
        assert not u[pins].any()
        if multipliers is not None:
            np.testing.assert_allclose(multipliers, expected[n * m : n * m + count], atol=1e-8 * size, rtol=0)


@pytest.mark.parametrize("name", ["some", "in a row", "all", "one part"])
@pytest.mark.parametrize("weight", [0.0, 1.0, 1e3])
@pytest.mark.parametrize(
    "at",
    [METRICS["l2"].at, lambda curve: DenseInnerProduct(METRICS["l2"].at(curve).dense()), INNER_PRODUCTS["compressed"]],
)
def test_penalised_metrics_vanish_at_pins_too(name: str, weight: float, at) -> None:
    curve, constraints = constraints_of(name)
    (n, m), pins = curve.vertices.shape, constraints.pins.vertices
    inner, lengths = at(curve), ConstraintDerivative.of_lengths(curve, pins)
    free = np.setdiff1d(np.arange(n * m).reshape(n, m), np.arange(n * m).reshape(n, m)[pins])
    rows = columns(lengths)
    full = np.kron(inner.dense(), np.eye(m)) + weight * rows.T @ rows
    eta = np.random.default_rng(89).normal(size=(n, m))
    u, _ = inner.tangent_space(lengths, np.full(n, weight)).gradient(eta)
    expected = np.zeros(n * m)
    expected[free] = np.linalg.solve(full[np.ix_(free, free)], eta.ravel()[free])
    np.testing.assert_allclose(u.ravel(), expected, rtol=1e-7, atol=1e-9 * (np.abs(expected).max() + 1e-300))
    assert not u[pins].any()


@NAMES
def test_small_corrections_leave_pins_alone(name: str) -> None:
    """u = −Lᵀ (L Lᵀ)⁻¹ Φ, L the rows of the lengths without the columns of pins, and translations of free parts."""
    curve, constraints = constraints_of(name)
    derivative, (n, m) = constraints.derivative(curve), curve.vertices.shape
    residual = np.random.default_rng(97).normal(size=derivative.count)
    u = euclidean_correction(constraints, curve, residual)
    assert not u[constraints.pins.vertices].any()
    np.testing.assert_allclose(derivative.apply(u), -residual, atol=1e-10 * np.abs(u).max() / curve.edge_lengths.min())
    shortest = -np.linalg.pinv(derivative.length_rows().toarray()) @ residual[: len(derivative.edges)]
    moved = u - shortest.reshape(n, m)
    parts = constraints.block(Barycenters).memberships(curve.mesh)
    own = np.concatenate([np.flatnonzero(own) for own in parts] or [[]]).astype(int)
    np.testing.assert_allclose(np.delete(moved, own, axis=0), 0.0, atol=1e-9 * (np.abs(u).max() + 1e-300))


def test_models_with_pins_are_symmetric_and_positive_definite_on_what_is_free() -> None:
    curve, constraints = constraints_of("in a row")
    inner, pins = moebius_inner_product(curve), constraints.pins.vertices
    inverse = PinnedModel(inner.model, curve.mesh, pins).solve(np.eye(len(curve)))
    np.testing.assert_allclose(inverse, inverse.T, atol=1e-12 * np.abs(inverse).max())
    free = np.setdiff1d(np.arange(len(curve)), pins)
    assert not inverse[pins].any()
    kept = inner.dense()[np.ix_(free, free)]
    ratios = np.linalg.eigvals(inverse[np.ix_(free, free)] @ kept).real
    whole = np.linalg.eigvals(inner.model.solve(np.eye(len(curve))) @ inner.dense()).real
    assert 0.9 * whole.min() < ratios.min() < ratios.max() < 1.1 * whole.max()


def test_a_dense_inner_product_keeps_its_inverse_for_the_same_pins() -> None:
    curve, constraints = constraints_of("some")
    inner, derivative = METRICS["moebius"].at(curve), constraints.derivative(curve)
    before, again = inner.tangent_space(derivative), inner.tangent_space(derivative)
    assert before._inner is again._inner
    other = inner.tangent_space(Constraints.of(curve, Pins.of(curve, np.array([7]))).derivative(curve))
    assert not other.gradient(np.ones(curve.vertices.shape))[0][7].any()


def test_sparse_and_dense_tangent_spaces_agree() -> None:
    curve, constraints = constraints_of("in a row")
    derivative, eta = constraints.derivative(curve), np.random.default_rng(103).normal(size=curve.vertices.shape)
    sparse = METRICS["h2"].at(curve)
    assert isinstance(sparse, SparseInnerProduct)
    assert sp.issparse(sparse.matrix)
    u, _ = sparse.tangent_space(derivative).gradient(eta)
    expected, _ = DenseInnerProduct(sparse.dense()).tangent_space(derivative).gradient(eta)
    np.testing.assert_allclose(u, expected, atol=1e-8 * np.abs(expected).max())
