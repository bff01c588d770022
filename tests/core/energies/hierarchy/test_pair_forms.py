"""Forms on a block list against the sum over all its pairs of edges."""

from collections.abc import Iterator

import numpy as np
import pytest
from mobius_flow.core import Curve
from mobius_flow.core.energies.hierarchy import BlockList
from mobius_flow.core.solve.hierarchical import PairForms, RunningSum
from shapes import chain_of_rings, hopf_link, opened, torus_trefoil
from smooth_curves import random_polygon

CURVES = {
    "knot": torus_trefoil(120),
    "tangle": random_polygon(3, (61,), 3),
    "plane": random_polygon(3, (61,), 2),
    "hopf": hopf_link(37),
    "chain": chain_of_rings(7, (5, 3, 12)),
    "arcs": opened(chain_of_rings(7, (5, 3, 12)), 0, 1, 2, 5),
}
CURVE = pytest.mark.parametrize("curve", CURVES.values(), ids=CURVES)


def forms_with_weights(curve: Curve) -> tuple[BlockList, np.ndarray, np.ndarray]:
    blocks, rng = BlockList.of(curve, 0.5, 4), np.random.default_rng(19)
    return blocks, rng.uniform(size=len(blocks.near[0])), rng.uniform(size=len(blocks.first))


def weighted_pairs(blocks: BlockList, near: np.ndarray, far: np.ndarray) -> Iterator[tuple[int, int, float]]:
    yield from zip(*blocks.near, near, strict=True)
    for (a, b, c, d), weight in zip(blocks.ranges.T, far, strict=True):
        for i in blocks.tree.order[a:b]:
            for j in blocks.tree.order[c:d]:
                yield i, j, weight


def by_pairs(curve: Curve, pairs: Iterator[tuple[int, int, float]], x: np.ndarray) -> float:
    """Σ w ℓ_I ℓ_J (x_I − x_J)² over ordered pairs."""
    ell = curve.edge_lengths
    return 2 * sum(weight * ell[i] * ell[j] * (x[i] - x[j]) ** 2 for i, j, weight in pairs)


@CURVE
def test_slopes_and_values(curve: Curve) -> None:
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


@CURVE
def test_components(curve: Curve) -> None:
    """Only clusters of several components are left out, which some curves do not have."""
    blocks, near, far = forms_with_weights(curve)
    component = curve.mesh.edge_component
    u = np.random.default_rng(23).normal(size=len(curve.mesh.component_sizes))
    order = component[blocks.tree.order]
    a, b, c, d = blocks.ranges
    several = (order[a] != order[b - 1]) | (order[c] != order[d - 1])
    expected = by_pairs(curve, weighted_pairs(blocks, near, np.where(several, 0.0, far)), u[component])
    assert u @ PairForms(curve, blocks).of_components(near, far) @ u == pytest.approx(expected, rel=1e-11)


@CURVE
def test_running_sum(curve: Curve) -> None:
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
