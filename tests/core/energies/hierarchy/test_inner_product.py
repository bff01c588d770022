"""Compressed inner products, the sums over pairs that they are made of, and the polynomials of their kernels."""

import numpy as np
import pytest
import scipy.sparse as sp
from mobius_flow.core.curve import refine
from mobius_flow.core.energies.hierarchy import BlockList
from mobius_flow.core.energies.hierarchy.polynomials import kernel_derivatives, polynomials
from mobius_flow.core.knots import HARD_UNKNOTS, knot, torus_knot
from mobius_flow.core.solve import hierarchical
from mobius_flow.core.solve.hierarchical import PairForms, RunningSum, fractional_inner_product, moebius_inner_product
from mobius_flow.core.solve.metrics import METRICS, SparseInnerProduct
from mobius_flow.core.solve.saddle.iterative import conjugate_gradients, relative
from scipy.linalg import eigvalsh
from shapes import chain_of_rings, graded_trefoil, hopf_link, opened, regular_polygon, torus_trefoil
from smooth_curves import random_polygon

COMPRESSED = {"moebius": moebius_inner_product, "h3-2": fractional_inner_product}
CURVES = {
    "knot": torus_trefoil(200),
    "graded": graded_trefoil(300, 30.0),
    "tangle": random_polygon(3, (61,), 3),
    "plane": regular_polygon(90, 2),
    "4-space": random_polygon(3, (61,), 4),
    "hopf": hopf_link(50),
    "chain": chain_of_rings(9, (15, 30)),
    "arc": opened(torus_trefoil(200), 0),
    "arcs": opened(chain_of_rings(9, (15, 30)), 0, 2, 3, 4, 8),
}
METRIC = pytest.mark.parametrize("name", COMPRESSED)
CURVE = pytest.mark.parametrize("curve", CURVES.values(), ids=CURVES)


def solved(inner, force):
    return conjugate_gradients(inner.apply, relative(inner.model.solve, 1e-10), force, 1000)


def assert_equivalent(name, curve):
    """Eigenvalues relative to the exact inner product."""
    eigenvalues = eigvalsh(COMPRESSED[name](curve).dense(), METRICS[name].at(curve).dense())
    assert eigenvalues[0] > 0.8
    assert eigenvalues[-1] < 1.2


@METRIC
@CURVE
def test_a_compressed_product_is_near_the_exact_one_symmetric_and_solved_with(name, curve, monkeypatch):
    """It is exact where all pairs are near."""
    expected = METRICS[name].at(curve).dense()
    with monkeypatch.context() as patch:
        patch.setattr(hierarchical, "block_list", lambda each: BlockList.of(each, 0.5, len(each)))
        found = COMPRESSED[name](curve).dense()
    np.testing.assert_allclose(found, expected, atol=1e-12 * np.abs(expected).max(), rtol=0)
    assert_equivalent(name, curve)
    inner = COMPRESSED[name](curve)
    matrix = inner.apply(np.eye(len(curve)))
    np.testing.assert_allclose(matrix, matrix.T, atol=1e-12 * np.abs(matrix).max(), rtol=0)
    u = np.random.default_rng(31).normal(size=(len(curve), 2))
    np.testing.assert_allclose(solved(inner, inner.apply(u)), u, atol=1e-7)


@pytest.mark.parametrize("unknot", HARD_UNKNOTS)
def test_near_the_exact_one_on_tangles(unknot):
    assert_equivalent("moebius", refine(knot(unknot)))


@METRIC
def test_sums(name):
    curve = CURVES["chain"]
    inner, other = COMPRESSED[name](curve), METRICS["h1"].at(curve)
    total = inner.plus(other)
    expected = inner.dense() + other.dense()
    np.testing.assert_allclose(total.dense(), expected, atol=1e-12 * np.abs(expected).max(), rtol=0)


def test_what_is_solved_with_first_knows_how_much_of_each_term_there_is():
    """A field constant on each ring is solved for at once, however much of a second metric there is."""
    curve = CURVES["chain"]
    inner, other = moebius_inner_product(curve), METRICS["l2"].at(curve)
    rings = np.eye(len(curve.mesh.component_sizes))[curve.mesh.component]
    for weight in (1e-3, 1e3):
        added = inner.plus(SparseInnerProduct(weight * other.matrix)).coupling.toarray() - inner.coupling.toarray()
        np.testing.assert_allclose(added, weight * rings.T @ other.dense() @ rings, rtol=1e-9, atol=1e-9 * weight)


def test_indefinite_products_are_refused():
    curve = CURVES["knot"]
    indefinite = moebius_inner_product(curve).plus(SparseInnerProduct(-1e6 * sp.eye_array(len(curve))))
    with pytest.raises(np.linalg.LinAlgError, match=r"not positive definite"):
        solved(indefinite, np.ones((len(curve), 1)))


@METRIC
def test_iterations_do_not_grow_with_the_mesh(monkeypatch, name):
    counts = []
    for n in (500, 2000, 8000):
        curve = torus_knot(2, 3, n)
        inner, products = COMPRESSED[name](curve), []
        load = np.sin(3 * curve.vertices) * curve.edge_lengths[:, None]
        monkeypatch.setattr(type(inner), "apply", counted(type(inner).apply, products))
        solved(inner, load)
        monkeypatch.undo()
        counts.append(len(products))
    assert max(counts) <= min(counts) + 3


def counted(method, calls):
    def wrapper(*arguments):
        calls.append(arguments)
        return method(*arguments)

    return wrapper


SMALL = {
    "knot": torus_trefoil(120),
    "tangle": random_polygon(3, (61,), 3),
    "plane": random_polygon(3, (61,), 2),
    "hopf": hopf_link(37),
    "chain": chain_of_rings(7, (5, 3, 12)),
    "arcs": opened(chain_of_rings(7, (5, 3, 12)), 0, 1, 2, 5),
}
EACH = pytest.mark.parametrize("curve", SMALL.values(), ids=SMALL)


def forms_with_weights(curve):
    blocks, rng = BlockList.of(curve, 0.5, 4), np.random.default_rng(19)
    return blocks, rng.uniform(size=len(blocks.near[0])), rng.uniform(size=len(blocks.first))


def weighted_pairs(blocks, near, far):
    yield from zip(*blocks.near, near, strict=True)
    for (a, b, c, d), weight in zip(blocks.ranges.T, far, strict=True):
        for i in blocks.tree.order[a:b]:
            for j in blocks.tree.order[c:d]:
                yield i, j, weight


def by_pairs(curve, pairs, x):
    """Σ w ℓ_I ℓ_J (x_I − x_J)² over ordered pairs."""
    ell = curve.edge_lengths
    return 2 * sum(weight * ell[i] * ell[j] * (x[i] - x[j]) ** 2 for i, j, weight in pairs)


@EACH
def test_slopes_and_values(curve):
    blocks, near, far = forms_with_weights(curve)
    u, forms = np.random.default_rng(23).normal(size=len(curve)), PairForms(curve, blocks)
    expected = by_pairs(curve, weighted_pairs(blocks, near, far), (curve.mesh.difference @ u) / curve.edge_lengths)
    y = RunningSum.of_slopes(curve, blocks.tree.order).apply(u[:, None])[:, 0]
    found = u @ forms.of_slopes(near, far) @ u + y @ forms.of_long_slopes(far) @ y
    assert found == pytest.approx(expected, rel=1e-11)
    expected = by_pairs(curve, weighted_pairs(blocks, near, far), curve.mesh.average @ u)
    local, sums = forms.of_values(near, far)
    z = RunningSum.of_values(curve, blocks.tree.order).apply(u[:, None])[:, 0]
    assert u @ local @ u + z @ sums @ z == pytest.approx(expected, rel=1e-11)


@EACH
def test_components(curve):
    """Only clusters of several components are left out, which some curves do not have."""
    blocks, near, far = forms_with_weights(curve)
    component = curve.mesh.edge_component
    u = np.random.default_rng(23).normal(size=len(curve.mesh.component_sizes))
    order = component[blocks.tree.order]
    a, b, c, d = blocks.ranges
    several = (order[a] != order[b - 1]) | (order[c] != order[d - 1])
    expected = by_pairs(curve, weighted_pairs(blocks, near, np.where(several, 0.0, far)), u[component])
    assert u @ PairForms(curve, blocks).of_components(near, far) @ u == pytest.approx(expected, rel=1e-11)


@EACH
def test_running_sum(curve):
    order = BlockList.of(curve, 0.5, 4).tree.order
    running, n = RunningSum.of_values(curve, order), len(curve)
    u = np.random.default_rng(29).normal(size=(n, 2))
    steps = (curve.edge_lengths[:, None] * (curve.mesh.average @ u))[order]
    np.testing.assert_allclose(
        running.apply(u), np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)]), atol=1e-14
    )
    for each in (running, RunningSum.of_slopes(curve, order)):
        ones = np.eye(curve.mesh.edges + 1)
        np.testing.assert_allclose(each.apply_transpose(ones), each.apply(np.eye(n)).T, atol=1e-14)


DIMENSION = pytest.mark.parametrize("m", [2, 3, 4])
DEGREE = 5


@DIMENSION
@pytest.mark.parametrize("k", [0, 1])
def test_kernel_derivatives_are_the_taylor_coefficients(m, k):
    kernel = [lambda x: 1 / (x @ x), lambda x: 0.5 * np.log(x @ x)][k]
    table = polynomials(m, DEGREE)
    d, w = np.random.default_rng(23).normal(size=(2, m))
    d *= 2.0 / np.linalg.norm(d)
    derivatives = kernel_derivatives(table, d[:, None], DEGREE - 2)[k]
    degree = DEGREE - 2 + 2 * k
    errors = []
    for t in (0.04, 0.02):
        series = np.sum(derivatives * table.exponentials(t * w[:, None], degree))
        errors.append(abs(kernel(d + t * w) - (kernel(d) if k == 1 else 0.0) - series))
    assert np.log2(errors[0] / errors[1]) == pytest.approx(degree + 1, abs=0.3)
