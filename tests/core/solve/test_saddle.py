"""The structured solver against the paper's dense LU of (41)."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from families import crossed
from mobius_flow.core import Curve, Objective
from mobius_flow.core.solve.constraints import ConstraintDerivative, Constraints
from mobius_flow.core.solve.hierarchical import fractional_inner_product, moebius_inner_product
from mobius_flow.core.solve.metrics import METRICS, DenseInnerProduct, SparseInnerProduct
from mobius_flow.core.solve.saddle.iterative import Tolerances
from shapes import half_circle, hopf_link, opened, regular_polygon, torus_trefoil
from taylor import taylor_slope


def rough(curve: Curve, seed: int = 7) -> Curve:
    rng = np.random.default_rng(seed)
    return curve.with_vertices(curve.vertices + 0.02 * rng.normal(size=curve.vertices.shape))


CURVES = {
    "trefoil": rough(torus_trefoil(60)),
    "link": rough(hopf_link(40)),
    "plane": rough(regular_polygon(30, dimension=2)),
    "4-space": rough(regular_polygon(30, dimension=4)),
    "triangle": rough(regular_polygon(3)),
    "arcs": rough(opened(Curve.from_components([half_circle(30).vertices, torus_trefoil(40).vertices + 3.0]), 0)),
    "short arc": rough(half_circle(2)),
}
TO_ROUNDING = Tolerances(gradient=1e-11, correction=1e-11, preconditioner=1e-11, feasibility=1e-12)
INNER_PRODUCTS = {name: metric.at for name, metric in METRICS.items()} | {
    "compressed h3-2": lambda curve: fractional_inner_product(curve, TO_ROUNDING),
    "compressed moebius": lambda curve: moebius_inner_product(curve, TO_ROUNDING),
}


def dense(curve: Curve, matrix: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    n, m = curve.vertices.shape
    derivative = Constraints.of(curve).derivative(curve)
    columns = [derivative.apply(unit.reshape(n, m)) for unit in np.eye(n * m)]
    c = np.stack(columns, axis=1)
    return np.block([[np.kron(matrix, np.eye(m)), c.T], [c, np.zeros((len(c), len(c)))]]), c


@pytest.mark.parametrize(("name", "product"), crossed(CURVES, INNER_PRODUCTS))
def test_agrees_with_dense_lu(name, product):
    curve = CURVES[name]
    n, m = curve.vertices.shape
    inner = INNER_PRODUCTS[product](curve)
    if name == "triangle":  # no pairs of disjoint edges: J_C needs its local part
        inner = inner.plus(SparseInnerProduct(sp.eye_array(n)))
    matrix = inner.dense()
    full, c = dense(curve, matrix)
    solver = inner.tangent_space(Constraints.of(curve).derivative(curve))
    rng = np.random.default_rng(3)
    eta, xi, v = rng.normal(size=(n, m)), rng.normal(size=len(c)), rng.normal(size=(n, m))
    for right, (u, multipliers) in [
        ((eta, np.zeros(len(c))), solver.gradient(eta)),
        ((np.zeros((n, m)), xi), solver.solve(None, xi)),
        ((eta, xi), solver.solve(eta, xi)),
        (((matrix @ v), np.zeros(len(c))), (solver.project(v), None)),
    ]:
        expected = np.linalg.solve(full, np.concatenate([right[0].ravel(), right[1]]))
        np.testing.assert_allclose(u.ravel(), expected[: n * m], atol=1e-9 * np.abs(expected).max(), rtol=0)
        if multipliers is not None:
            np.testing.assert_allclose(multipliers, expected[n * m :], atol=1e-9 * np.abs(expected).max(), rtol=0)
    np.testing.assert_allclose(c @ solver.project(v).ravel(), 0, atol=1e-10 * np.abs(v).max() * np.abs(c).max())


def test_projection_is_idempotent_and_orthogonal():
    curve = CURVES["trefoil"]
    solver = METRICS["moebius"].at(curve).tangent_space(Constraints.of(curve).derivative(curve))
    v = np.random.default_rng(5).normal(size=curve.vertices.shape)
    p = solver.project(v)
    np.testing.assert_allclose(solver.project(p), p, atol=1e-10)
    assert abs(np.sum(p * solver.apply(v - p))) < 1e-9 * solver.norm(v) ** 2


def test_indefinite_matrix_is_refused():
    curve = CURVES["trefoil"]
    with pytest.raises(np.linalg.LinAlgError, match="not positive definite"):
        DenseInnerProduct(-np.eye(len(curve))).tangent_space(Constraints.of(curve).derivative(curve))


WHOLE_SPACES = {
    "sparse": METRICS["l2"].at,
    "dense": lambda curve: DenseInnerProduct(METRICS["l2"].at(curve).dense()),
    "compressed": INNER_PRODUCTS["compressed moebius"],
}


@pytest.mark.parametrize("at", WHOLE_SPACES.values(), ids=WHOLE_SPACES)
@pytest.mark.parametrize("weight", [0.0, 1e-200, 1.0, 1e3])
@pytest.mark.parametrize("name", ["link", "arcs"])
def test_weighted_constraints_are_a_part_of_the_metric(name, weight, at):
    """(J + DΦᵀ w DΦ) u = η, also where a weight is nothing or next to nothing."""
    curve = CURVES[name]
    n, m = curve.vertices.shape
    inner = at(curve)
    matrix = inner.dense()
    lengths = ConstraintDerivative.of_lengths(curve)
    rows = np.stack([lengths.apply(unit.reshape(n, m)) for unit in np.eye(n * m)], axis=1)
    weights = np.where(np.arange(curve.mesh.edges) % 3 == 0, weight, 2.0 * weight)
    full = np.kron(matrix, np.eye(m)) + rows.T @ (weights[:, None] * rows)
    eta = np.random.default_rng(17).normal(size=(n, m))
    solver = inner.tangent_space(lengths, weights)
    u, _ = solver.gradient(eta)
    expected = np.linalg.solve(full, eta.ravel())
    # relative errors grow by κ when rounded, and by √κ when iterated to a tolerance in the norm of the matrix
    condition = np.linalg.cond(full)
    bound = 8 * condition * np.finfo(float).eps + np.sqrt(condition) * TO_ROUNDING.gradient
    assert np.linalg.norm(u.ravel() - expected) < bound * np.linalg.norm(expected)
    assert np.linalg.norm(solver.apply(u) - eta) < bound * np.linalg.norm(eta)


@pytest.mark.parametrize("name", CURVES)
def test_constraint_derivative_has_slope_two(name):
    curve = CURVES[name]
    constraints = replace(Constraints.of(curve), lengths=np.full(curve.mesh.edges, 0.1))
    u = np.random.default_rng(11).normal(size=curve.vertices.shape) * 0.01
    linear = Constraints.of(curve).derivative(curve).apply(u)
    along = [constraints.residual(curve), linear]
    slope = taylor_slope(
        lambda t: constraints.residual(curve.with_vertices(curve.vertices + t * u)), along, largest=1.0
    )
    assert abs(slope - 2) < 0.1


@pytest.mark.parametrize("name", ["link", "arcs"])
def test_transpose_is_adjoint(name):
    curve = CURVES[name]
    derivative = Constraints.of(curve).derivative(curve)
    rng = np.random.default_rng(13)
    u, multipliers = rng.normal(size=curve.vertices.shape), rng.normal(size=derivative.count)
    assert derivative.apply(u) @ multipliers == pytest.approx(np.sum(u * derivative.apply_transpose(multipliers)))


def test_targets_vanish_at_the_start():
    curve = CURVES["trefoil"]
    constraints = Constraints.of(curve)
    np.testing.assert_allclose(constraints.residual(curve), 0, atol=1e-14)


def test_gradient_is_a_direction_of_descent_along_the_constraints():
    curve = CURVES["trefoil"]
    solver = METRICS["moebius"].at(curve).tangent_space(Constraints.of(curve).derivative(curve))
    _, derivative = Objective().value_and_derivative(curve)
    u, _ = solver.gradient(derivative)
    assert np.sum(u * derivative) == pytest.approx(solver.norm(u) ** 2)
    assert np.sum(u * derivative) > 0
