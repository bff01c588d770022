"""Compressed inner products against dense ones."""

import numpy as np
import pytest
import scipy.sparse as sp
from mobius_flow.core import Curve
from mobius_flow.core.curve import refine
from mobius_flow.core.knots import HARD_UNKNOTS, knot, torus_knot
from mobius_flow.core.solve.hierarchical import CompressedMetric, fractional_inner_product, moebius_inner_product
from mobius_flow.core.solve.metrics import METRICS, DenseInnerProduct, SparseInnerProduct
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


def assert_equivalent(name: str, curve: Curve) -> None:
    """Eigenvalues relative to the exact inner product."""
    eigenvalues = eigvalsh(COMPRESSED[name](curve).dense(), METRICS[name].at(curve).dense())
    assert eigenvalues[0] > 0.8
    assert eigenvalues[-1] < 1.2


@METRIC
@CURVE
def test_a_compressed_product_is_near_the_exact_one_symmetric_and_solved_with(name: str, curve: Curve) -> None:
    """It is exact where all pairs are near."""
    expected = METRICS[name].at(curve).dense()
    found = CompressedMetric(METRICS[name], leaf=len(curve)).at(curve).dense()
    np.testing.assert_allclose(found, expected, atol=1e-12 * np.abs(expected).max(), rtol=0)
    assert_equivalent(name, curve)
    inner = COMPRESSED[name](curve)
    matrix = inner.apply(np.eye(len(curve)))
    np.testing.assert_allclose(matrix, matrix.T, atol=1e-12 * np.abs(matrix).max(), rtol=0)
    u = np.random.default_rng(31).normal(size=(len(curve), 2))
    np.testing.assert_allclose(inner.solve(inner.apply(u)), u, atol=1e-7)


@pytest.mark.parametrize("unknot", HARD_UNKNOTS)
def test_near_the_exact_one_on_tangles(unknot: str) -> None:
    assert_equivalent("moebius", refine(knot(unknot)))


@METRIC
@pytest.mark.parametrize("sum_with", ["compressed", "sparse", "dense"])
def test_sums(name: str, sum_with: str) -> None:
    curve = CURVES["chain"]
    inner, n = COMPRESSED[name](curve), len(curve)
    other = {
        "compressed": fractional_inner_product(curve),
        "sparse": METRICS["h1"].at(curve),
        "dense": DenseInnerProduct(METRICS["h2"].at(curve).dense()),
    }[sum_with]
    total = inner.plus(other, 0.3)
    expected = inner.dense() + 0.3 * other.dense()
    np.testing.assert_allclose(total.dense(), expected, atol=1e-12 * np.abs(expected).max(), rtol=0)
    u = np.random.default_rng(37).normal(size=(n, 2))
    np.testing.assert_allclose(total.solve(total.apply(u)), u, atol=1e-7)


def test_what_is_solved_with_first_knows_how_much_of_each_term_there_is() -> None:
    """A field constant on each ring is solved for at once, however much of a second metric there is."""
    curve = CURVES["chain"]
    inner, other = moebius_inner_product(curve), METRICS["l2"].at(curve)
    rings = np.eye(len(curve.mesh.component_sizes))[curve.mesh.component]
    for weight in (1e-3, 1e3):
        added = inner.plus(other, weight).coupling.toarray() - inner.coupling.toarray()
        np.testing.assert_allclose(added, weight * rings.T @ other.dense() @ rings, rtol=1e-9, atol=1e-9 * weight)


def test_indefinite_products_are_refused() -> None:
    curve = CURVES["knot"]
    indefinite = moebius_inner_product(curve).plus(SparseInnerProduct(-1e6 * sp.eye_array(len(curve))))
    with pytest.raises(np.linalg.LinAlgError, match=r"not positive definite"):
        indefinite.solve(np.ones((len(curve), 1)))


@METRIC
def test_iterations_do_not_grow_with_the_mesh(monkeypatch, name: str) -> None:
    counts = []
    for n in (500, 2000, 8000):
        curve = torus_knot(2, 3, n)
        inner, products = COMPRESSED[name](curve), []
        load = np.sin(3 * curve.vertices) * curve.edge_lengths[:, None]
        monkeypatch.setattr(type(inner), "apply", counted(type(inner).apply, products))
        inner.solve(load)
        monkeypatch.undo()
        counts.append(len(products))
    assert max(counts) <= min(counts) + 3


def counted(method, calls):
    def wrapper(*arguments):
        calls.append(arguments)
        return method(*arguments)

    return wrapper
