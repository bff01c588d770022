"""Iterative solvers: Krylov methods, and tangent spaces solved with them."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from descent_contracts import point_on
from mobius_flow.core import Curve, Objective
from mobius_flow.core.curve import refine
from mobius_flow.core.descent import METHODS, SearchState, Step
from mobius_flow.core.descent.task import centred
from mobius_flow.core.knots import knot, torus_knot
from mobius_flow.core.solve.constraints import Constraints
from mobius_flow.core.solve.hierarchical import CompressedInnerProduct, moebius_inner_product
from mobius_flow.core.solve.metrics import DenseInnerProduct, MoebiusMetric
from mobius_flow.core.solve.saddle.iterative import (
    IterativeTangentSpace,
    Tolerances,
    conjugate_gradients,
    relative,
    stopping,
)
from shapes import chain_of_rings, graded_trefoil, hopf_link, torus_trefoil

CURVES = {
    "knot": torus_trefoil(300).with_vertices(torus_trefoil(300).vertices * [1.0, 1.3, 1.1]),
    "tangle": refine(knot("ochiai-1")),
    "graded": graded_trefoil(400, 20.0),
    "plane": refine(Curve([[0, 0], [4, 0], [4, 1], [1, 1], [1, 2], [4, 2], [4, 3], [0, 3]]), 200),
    "hopf": hopf_link(80),
    "chain": chain_of_rings(12, (15, 30, 8)),
}
CURVE = pytest.mark.parametrize("name", CURVES)


@cache
def spaces(name):
    """The iterative tangent space, and the same by dense factorisations."""
    curve = centred(CURVES[name])
    inner, constraints = moebius_inner_product(curve), Constraints.of(curve).derivative(curve)
    return inner.tangent_space(constraints), DenseInnerProduct(inner.dense()).tangent_space(constraints)


@cache
def derivative(name):
    return Objective().value_and_derivative(centred(CURVES[name]))[1]


@CURVE
def test_gradient(name):
    space, dense = spaces(name)
    covector = derivative(name)
    (u, multipliers), (expected, forces) = space.gradient(covector), dense.gradient(covector)
    size = dense.norm(expected)
    assert dense.norm(u - expected) < 1e-2 * size
    assert np.sqrt(np.sum(covector * u)) == pytest.approx(size, rel=1e-4)
    assert np.abs(space.constraints.apply(u)).max() < 1e-10 * np.abs(space.constraints.tangents).max() * np.abs(u).max()
    # multipliers by what they do, the displacement that corresponds to their pull; no tolerance is theirs, and those of
    # the gradient leave them less exact where edges are of very different lengths
    pull = space.constraints.apply_transpose(multipliers - forces)
    displacement = spaces(name)[1]._solve(pull)
    assert np.sqrt(np.sum(pull * displacement)) < (6e-2 if name == "graded" else 1.5e-2) * size


@CURVE
@pytest.mark.parametrize("accuracy", [1e-3, 1e-6, 1e-8])
def test_norm_is_as_accurate_as_asked_for(name, accuracy):
    curve = centred(CURVES[name])
    inner = moebius_inner_product(curve, Tolerances.of_norms(accuracy))
    u, _ = inner.tangent_space(Constraints.of(curve).derivative(curve)).gradient(derivative(name))
    expected, _ = spaces(name)[1].gradient(derivative(name))
    square = np.sum(derivative(name) * expected)
    assert np.sqrt(np.sum(derivative(name) * u) / square) == pytest.approx(1, abs=accuracy)


@CURVE
def test_pseudo_inverse(name):
    space, dense = spaces(name)
    xi = space.constraints.apply(0.05 * np.sin(3 * CURVES[name].vertices))
    u = space.pseudo_inverse(xi)
    np.testing.assert_allclose(space.constraints.apply(u), xi, atol=1e-9 * np.abs(xi).max())
    assert dense.norm(u) < 1.01 * dense.norm(dense.pseudo_inverse(xi))


@CURVE
def test_projection(name):
    """What is nearly tangent is projected nearly exactly."""
    space, dense = spaces(name)
    v = dense.project(np.sin(CURVES[name].vertices)) + 1e-3 * np.cos(CURVES[name].vertices)
    p = space.project(v)
    assert np.abs(space.constraints.apply(p)).max() < 1e-9 * np.abs(space.constraints.apply(v)).max()
    assert dense.norm(p - dense.project(v)) < 0.1 * dense.norm(v - dense.project(v))


def outer_iterations(monkeypatch, space, covector):
    """How many products with A a projected gradient takes, checked to be one."""
    calls = 0
    original = CompressedInnerProduct.apply

    def apply(self, u):
        nonlocal calls
        calls += 1
        return original(self, u)

    monkeypatch.setattr(CompressedInnerProduct, "apply", apply)
    u, _ = space.gradient(covector)
    monkeypatch.undo()
    assert np.sum(u * covector) > 0
    return calls


def smooth_load(curve):
    """A covector that does not depend on the mesh, but for its quadrature."""
    return np.sin(3 * curve.vertices) * curve.edge_lengths[:, None]


def space_at(curve):
    return moebius_inner_product(curve).tangent_space(Constraints.of(curve).derivative(curve))


@pytest.mark.parametrize("kind", ["torus", "tangle"])
def test_iterations_do_not_grow_with_the_mesh(monkeypatch, kind):
    coarse = torus_knot(2, 3, 500) if kind == "torus" else refine(knot("culprit"), 500)
    curves = (coarse, refine(coarse, 2000), refine(coarse, 8000))
    counts = [outer_iterations(monkeypatch, space_at(curve), smooth_load(curve)) for curve in curves]
    assert max(counts) <= counts[0] + 4
    assert counts[0] <= (8 if kind == "torus" else 25)


def with_compressed_metric(curve):
    class Compressed(MoebiusMetric):
        def at(self, curve):
            return moebius_inner_product(curve)

    point = point_on(curve)
    return replace(point.problem, metric=Compressed()).at_curve(curve)


@pytest.mark.parametrize("name", ["knot", "tangle", "chain"])
def test_the_way_back_takes_few_solves_in_the_metric(monkeypatch, name):
    point = with_compressed_metric(CURVES[name])
    step = 0.02 / np.abs(point.tangent_space.constraints.apply(np.sin(point.vertices))).max()
    calls = []
    original = IterativeTangentSpace.pseudo_inverse
    monkeypatch.setattr(IterativeTangentSpace, "pseudo_inverse", lambda self, xi: calls.append(1) or original(self, xi))
    end = point.retract(point.vertices + step * np.sin(point.vertices), point.residual)
    assert point.problem.constraints.error(point.problem.mesh, end.residual - point.residual) <= 1e-11
    assert 1 <= len(calls) <= 2


def test_too_few_iterations_are_an_error():
    curve = CURVES["tangle"]
    inner = moebius_inner_product(curve, Tolerances(max_iterations=3))
    with pytest.raises(np.linalg.LinAlgError, match="more than 3 iterations"):
        inner.tangent_space(Constraints.of(curve).derivative(curve)).gradient(smooth_load(curve))


def test_no_gradient_where_the_derivative_is_normal():
    space, _ = spaces("knot")
    normal = space.constraints.apply_transpose(np.cos(np.arange(space.constraints.count)))
    u, _ = space.gradient(normal)
    assert space.norm(u) < 1e-8 * np.sqrt(np.sum(normal * spaces("knot")[1]._solve(normal)))
    assert not np.any(space.gradient(np.zeros_like(u))[0])


@pytest.mark.parametrize("method", ["lbfgs", "cg", "trust-region", "penalty-lbfgs"])
def test_methods_descend_as_with_the_exact_metric(method):
    ends = []
    for start in (point_on(CURVES["knot"]), with_compressed_metric(CURVES["knot"])):
        rule = METHODS[method]
        point, state = replace(start.problem, geometry=rule.geometry).at_curve(CURVES["knot"]), SearchState()
        for _ in range(6):
            step, state = rule.rule.step(point, state)
            assert isinstance(step, Step)
            assert step.point.energy < point.energy
            point = step.point
        assert np.abs(point.residual).max() < 1e-10
        ends.append(point.energy)
    first = point_on(CURVES["knot"]).energy
    assert first - ends[1] > 0.9 * (first - ends[0])


RNG = np.random.default_rng(53)
FACTOR = RNG.normal(size=(30, 30))
MATRIX = FACTOR @ FACTOR.T + 0.1 * np.eye(30)
RIGHT = RNG.normal(size=(30, 3))


def product(x):
    return MATRIX @ x


def diagonal(r):
    return r / np.diag(MATRIX)[:, None]


@pytest.mark.parametrize("tolerance", [1e-3, 1e-6, 1e-10])
def test_solves(tolerance):
    x = conjugate_gradients(product, relative(diagonal, tolerance), RIGHT, 500)
    error = x - np.linalg.solve(MATRIX, RIGHT)
    assert np.sqrt(np.sum(error * product(error)) / np.sum(RIGHT * x)) < 100 * tolerance


def test_square_is_the_norm_of_the_solution():
    squares = []

    def enough(rho, square):
        squares.append(square)
        return rho < 1e-24

    x = conjugate_gradients(product, stopping(diagonal, enough), RIGHT, 500)
    assert squares == sorted(squares)
    assert squares[-1] == pytest.approx(np.sum(x * product(x)))


def test_a_preconditioner_may_vary():
    rng, seen = np.random.default_rng(59), list[float]()

    def precondition(r, decreases):
        seen[:] = decreases
        if len(decreases) > 2 and sum(decreases[-2:]) < 1e-20:
            return None
        return diagonal(r) * (1.0 + 0.05 * rng.normal(size=(30, 1))), r

    x = conjugate_gradients(product, precondition, RIGHT, 500)
    expected = np.linalg.solve(MATRIX, RIGHT)
    np.testing.assert_allclose(x, expected, atol=1e-7)
    assert sum(seen) == pytest.approx(np.sum(RIGHT * expected))


def test_nothing_to_solve():
    assert not np.any(conjugate_gradients(product, relative(diagonal, 1e-3), np.zeros((30, 3)), 10))
    assert not np.any(conjugate_gradients(product, lambda r, _: (r, r), np.zeros((30, 3)), 10))


def solve(matrix, iterations, *, indefinite=False):
    return conjugate_gradients(lambda x: matrix @ x, lambda r, _: (r, r), RIGHT, iterations, indefinite=indefinite)


def test_refusals():
    with pytest.raises(np.linalg.LinAlgError, match="not positive definite"):
        solve(-MATRIX, 10)
    with pytest.raises(np.linalg.LinAlgError, match="more than 4 iterations"):
        solve(MATRIX, 4)


def test_an_indefinite_operator_is_left_with_a_direction_of_descent():
    """The steepest one at first, and what was found so far later, or after the last iteration."""
    np.testing.assert_array_equal(solve(-MATRIX, 10, indefinite=True), RIGHT)
    part = solve(MATRIX, 4, indefinite=True)
    assert 0 < np.sum(RIGHT * part) < np.sum(RIGHT * np.linalg.solve(MATRIX, RIGHT))
    mixed = np.diag(np.where(np.arange(30) < 29, 1.0 + np.arange(30), -1e-3))
    assert np.sum(RIGHT * solve(mixed, 100, indefinite=True)) > 0
