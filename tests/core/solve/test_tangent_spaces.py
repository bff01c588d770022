"""Tangent spaces of every inner product against the whole matrix of (41), with a row for each pinned coordinate."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from families import crossed
from mobius_flow.core import Curve
from mobius_flow.core.curve.pins import Pins, free_edges
from mobius_flow.core.solve.constraints import Barycenters, ConstraintDerivative, Constraints
from mobius_flow.core.solve.hierarchical import fractional_inner_product, moebius_inner_product
from mobius_flow.core.solve.metrics import METRICS, DenseInnerProduct, SparseInnerProduct
from mobius_flow.core.solve.saddle.iterative import PinnedModel, Tolerances
from mobius_flow.core.solve.saddle.tangent_space import euclidean_correction
from shapes import half_circle, hopf_link, opened, regular_polygon, torus_trefoil
from taylor import taylor_slope


def rough(curve):
    rng = np.random.default_rng(71)
    return curve.with_vertices(curve.vertices + 0.02 * rng.normal(size=curve.vertices.shape))


TREFOIL, LINK, PLANE, IN_4 = (
    rough(curve) for curve in (torus_trefoil(60), hopf_link(20), regular_polygon(30, 2), regular_polygon(30, 4))
)
ARCS = rough(opened(Curve.from_components([half_circle(30).vertices, torus_trefoil(40).vertices + 3.0]), 0))
# curves, the parts of links, and pins
CASES: dict[str, tuple[Curve, tuple[int, ...] | None, list[int]]] = {
    "trefoil": (TREFOIL, None, []),
    "link": (LINK, None, []),
    "plane": (PLANE, None, []),
    "4-space": (IN_4, None, []),
    "triangle": (rough(regular_polygon(3)), None, []),
    "arcs": (ARCS, None, []),
    "short arc": (rough(half_circle(2)), None, []),
    "one pin": (TREFOIL, None, [17]),
    "the first": (TREFOIL, None, [0]),
    "some": (TREFOIL, None, [3, 20, 22, 41, 59]),
    "in a row": (TREFOIL, None, [0, 1, 2, 3, 4, 5, 6, 30, 59]),
    "all but one": (TREFOIL, None, list(range(1, 60))),
    "all": (TREFOIL, None, list(range(60))),
    "pinned link": (LINK, None, [25, 31]),
    "one part": (LINK, (1, 0), [4]),
    "two parts": (LINK, (0, 1), []),
    "pinned plane": (PLANE, None, [0, 9, 19]),
    "pinned 4-space": (IN_4, None, [0, 9, 19]),
}
NAMES = pytest.mark.parametrize("name", CASES)
EXACT = Tolerances(gradient=1e-11, correction=1e-11, preconditioner=1e-11, feasibility=1e-12)
INNER_PRODUCTS = {name: metric.at for name, metric in METRICS.items()} | {
    "compressed h3-2": lambda curve: fractional_inner_product(curve, EXACT),
    "compressed moebius": lambda curve: moebius_inner_product(curve, EXACT),
    "dense l2": lambda curve: DenseInnerProduct(METRICS["l2"].at(curve).dense()),
}


def case(name):
    curve, parts, vertices = CASES[name]
    pins = Pins.of(curve, np.array(vertices, dtype=np.intp))
    return curve, Constraints(curve.edge_lengths, Barycenters.of(curve, pins, parts), pins)


def inner_product(product, curve):
    inner = INNER_PRODUCTS[product](curve)  # a triangle has no pairs of disjoint edges: J_C needs its local part
    return inner.plus(SparseInnerProduct(sp.eye_array(3))) if len(curve) == 3 else inner


def rough_field(curve, pins):
    """It vanishes at pins."""
    u = np.random.default_rng(73).normal(size=curve.vertices.shape)
    u[pins] = 0.0
    return u


def columns(derivative):
    """DΦ as a matrix, with a column for every coordinate, pinned or not."""
    units = np.eye(int(np.prod(derivative.shape)))
    return np.stack([derivative.apply(unit.reshape(derivative.shape)) for unit in units], axis=1)


@pytest.mark.parametrize(("name", "product"), crossed(CASES, INNER_PRODUCTS))
def test_constrained(name, product):
    """The whole matrix of (41), [J Cᵀ Eᵀ; C 0 0; E 0 0], E the rows P_v = P⁰_v."""
    curve, constraints = case(name)
    derivative, pins = constraints.derivative(curve), constraints.pins.vertices
    (n, m), count = curve.vertices.shape, derivative.count
    inner, held = inner_product(product, curve), np.kron(np.eye(n)[pins], np.eye(m))
    rows = np.concatenate([columns(derivative), held])
    full = np.block([[np.kron(inner.dense(), np.eye(m)), rows.T], [rows, np.zeros((len(rows), len(rows)))]])
    space = inner.tangent_space(derivative)
    rng = np.random.default_rng(83)
    eta, xi, v = rng.normal(size=(n, m)), rng.normal(size=count), rough_field(curve, pins)
    projected = space.project(v)
    for right, below, (u, multipliers) in [
        (eta, np.zeros(count), space.gradient(eta)),
        (np.zeros((n, m)), xi, space.solve(None, xi)),
        (eta, xi, space.solve(eta, xi)),
        (inner.apply(v), np.zeros(count), (projected, None)),
    ]:
        expected = np.linalg.solve(full, np.concatenate([right.ravel(), below, np.zeros(len(held))]))
        size = max(np.abs(expected[: n * m + count]).max(), 1e-6)
        np.testing.assert_allclose(u.ravel(), expected[: n * m], atol=1e-8 * size, rtol=0)
        assert not u[pins].any()
        if multipliers is not None:
            np.testing.assert_allclose(multipliers, expected[n * m : n * m + count], atol=1e-8 * size, rtol=0)
    np.testing.assert_allclose(space.project(projected), projected, atol=1e-9 * np.abs(v).max())
    assert abs(np.sum(projected * space.apply(v - projected))) <= 1e-8 * space.norm(v) ** 2


@pytest.mark.parametrize("product", ["l2", "dense l2", "compressed moebius"])
@pytest.mark.parametrize("weight", [0.0, 1e-200, 1.0, 1e3])
@pytest.mark.parametrize("name", ["link", "arcs", "some", "in a row", "all", "one part"])
def test_penalised(name, weight, product):
    """(J + DΦᵀ w DΦ) u = η away from pins, also where a weight is nothing or next to nothing."""
    curve, constraints = case(name)
    (n, m), pins = curve.vertices.shape, constraints.pins.vertices
    inner, lengths = INNER_PRODUCTS[product](curve), ConstraintDerivative.of_lengths(curve, pins)
    places = np.arange(n * m).reshape(n, m)
    free = np.setdiff1d(places, places[pins])
    rows, weights = columns(lengths), np.where(np.arange(curve.mesh.edges) % 3 == 0, weight, 2.0 * weight)
    full = (np.kron(inner.dense(), np.eye(m)) + rows.T @ (weights[:, None] * rows))[np.ix_(free, free)]
    eta = np.random.default_rng(89).normal(size=(n, m))
    space = inner.tangent_space(lengths, weights)
    u, multipliers = space.gradient(eta)
    expected = np.linalg.solve(full, eta.ravel()[free])
    # relative errors grow by κ when rounded, and by √κ when iterated to a tolerance in the norm of the matrix
    condition = np.linalg.cond(full) if len(free) else 1.0
    bound = 8 * condition * np.finfo(float).eps + np.sqrt(condition) * EXACT.gradient
    assert np.linalg.norm(u.ravel()[free] - expected) <= bound * np.linalg.norm(expected)
    assert np.linalg.norm((space.apply(u) - eta).ravel()[free]) <= bound * np.linalg.norm(eta)
    assert not u[pins].any()
    assert not multipliers.any()
    assert space.project(eta) is eta


@NAMES
def test_the_derivative_has_slope_two_an_adjoint_and_full_rank(name):
    """Where vertices are free: lengths between pins are no rows, nor are barycenters of parts that are pinned."""
    curve, constraints = case(name)
    derivative, m, pins = constraints.derivative(curve), curve.dimension, constraints.pins.vertices
    np.testing.assert_allclose(constraints.residual(curve), 0, atol=1e-13)
    loose = len(constraints.barycenters.loose)
    assert derivative.count == len(free_edges(curve.mesh, pins)) + m * loose == len(constraints.residual(curve))
    multipliers, u = np.random.default_rng(79).normal(size=derivative.count), 0.01 * rough_field(curve, pins)
    assert derivative.apply(u) @ multipliers == pytest.approx(np.sum(u * derivative.apply_transpose(multipliers)))
    if derivative.count:
        stretched = replace(constraints, lengths=1.1 * constraints.lengths)
        along = [stretched.residual(curve), derivative.apply(u)]
        move = lambda t: stretched.residual(curve.with_vertices(curve.vertices + t * u))  # noqa: E731
        assert abs(taylor_slope(move, along, largest=1.0) - 2) < 0.1
        free = np.setdiff1d(np.arange(len(curve)), pins)
        matrix = columns(derivative)[:, (m * free[:, None] + np.arange(m)).ravel()]
        assert np.linalg.matrix_rank(matrix, tol=1e-8 * np.abs(matrix).max()) == derivative.count


def test_an_inverse_is_kept_only_for_the_pins_that_it_is_for():
    kept = INNER_PRODUCTS["moebius"](TREFOIL)
    for name in ("some", "trefoil"):
        derivative = case(name)[1].derivative(TREFOIL)
        eta = rough_field(TREFOIL, derivative.pins)
        afresh = INNER_PRODUCTS["moebius"](TREFOIL).tangent_space(derivative)
        assert np.array_equal(kept.tangent_space(derivative).solve(eta, None)[0], afresh.solve(eta, None)[0])


@NAMES
def test_small_corrections_leave_pins_alone(name):
    """u = −Lᵀ (L Lᵀ)⁻¹ Φ, L the rows of the lengths without the columns of pins, and translations of free parts."""
    curve, constraints = case(name)
    derivative, (n, m) = constraints.derivative(curve), curve.vertices.shape
    residual = np.random.default_rng(97).normal(size=derivative.count)
    u = euclidean_correction(constraints, curve, residual)
    assert not u[constraints.pins.vertices].any()
    np.testing.assert_allclose(derivative.apply(u), -residual, atol=1e-10 * np.abs(u).max() / curve.edge_lengths.min())
    moved = u + (np.linalg.pinv(derivative.length_rows().toarray()) @ residual[: len(derivative.edges)]).reshape(n, m)
    for block, own in ((c, moved[s]) for c, s in enumerate(curve.mesh.slices)):
        part = constraints.barycenters.parts[block]
        still = own if part not in constraints.barycenters.loose else own - own.mean(axis=0)
        np.testing.assert_allclose(still, 0.0, atol=1e-9 * (np.abs(u).max() + 1e-300))


def test_models_with_pins_are_symmetric_and_positive_definite_on_what_is_free():
    curve, constraints = case("in a row")
    inner, pins = moebius_inner_product(curve), constraints.pins.vertices
    inverse = PinnedModel(inner.model, curve.mesh, pins).solve(np.eye(len(curve)))
    np.testing.assert_allclose(inverse, inverse.T, atol=1e-12 * np.abs(inverse).max())
    free = np.setdiff1d(np.arange(len(curve)), pins)
    assert not inverse[pins].any()
    kept = inner.dense()[np.ix_(free, free)]
    ratios = np.linalg.eigvals(inverse[np.ix_(free, free)] @ kept).real
    whole = np.linalg.eigvals(inner.model.solve(np.eye(len(curve))) @ inner.dense()).real
    assert 0.9 * whole.min() < ratios.min() < ratios.max() < 1.1 * whole.max()


def test_a_dense_inner_product_keeps_its_inverse_for_the_same_pins():
    curve, constraints = case("some")
    inner, derivative = METRICS["moebius"].at(curve), constraints.derivative(curve)
    before, again = inner.tangent_space(derivative), inner.tangent_space(derivative)
    assert before._solve.args[0] is again._solve.args[0]
    other = inner.tangent_space(Constraints.of(curve, Pins.of(curve, np.array([7]))).derivative(curve))
    assert not other.gradient(np.ones(curve.vertices.shape))[0][7].any()


def test_an_indefinite_matrix_is_refused():
    curve, constraints = case("trefoil")
    with pytest.raises(np.linalg.LinAlgError, match="not positive definite"):
        DenseInnerProduct(-np.eye(len(curve))).tangent_space(constraints.derivative(curve))
