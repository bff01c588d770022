"""The block list covers every pair of edges once, and far pairs are far."""

import numpy as np
import pytest
from mobius_flow.core import Curve, OptionError
from mobius_flow.core.energies.hierarchy import BlockList
from mobius_flow.core.energies.hierarchy.blocks import edge_clusters
from shapes import hopf_link, opened, regular_polygon, scattered_rings, torus_trefoil
from smooth_curves import random_polygon

CURVES = {
    "triangle": regular_polygon(3),
    "plane": regular_polygon(50, 2),
    "knot": torus_trefoil(400),
    "tangle": random_polygon(3, (61,), 3),
    "hopf": hopf_link(37),
    "small": random_polygon(5, (3, 4, 5, 3, 11, 6), 3),
    "fourfold": random_polygon(7, (26, 37), 4),
    "rings": scattered_rings(150, 3),
    "arcs": opened(scattered_rings(150, 3), *range(0, 150, 4)),
    "planar rings": scattered_rings(40, 7, dimension=2),
    "uneven": Curve.from_components([*scattered_rings(30, 3).components, torus_trefoil(101).vertices]),
}
CURVE = pytest.mark.parametrize("curve", CURVES.values(), ids=CURVES)
LIST = pytest.mark.parametrize(("theta", "leaf"), [(0.2, 1), (0.25, 4), (0.5, 8), (0.9, 3)])


def multiplicity(blocks: BlockList) -> np.ndarray:
    """How often each pair of edges is counted, symmetric; shape (n, n)."""
    n = len(blocks.tree.order)
    far, near = np.zeros((n, n)), np.zeros((n, n))
    for a, b, c, d in blocks.ranges.T:
        far[a:b, c:d] += 1
    np.add.at(near, blocks.near, 1)
    near[np.ix_(blocks.tree.order, blocks.tree.order)] += far
    return near + near.T


@CURVE
@LIST
def test_every_pair_of_edges_exactly_once_and_far_ones_alone_in_blocks(curve: Curve, theta: float, leaf: int) -> None:
    blocks, edge = BlockList.of(curve, theta, leaf), np.arange(curve.mesh.edges)
    np.testing.assert_array_equal(multiplicity(blocks), curve.mesh.disjoint(edge[:, None], edge[None, :]))
    assert np.all(blocks.near[0] < blocks.near[1])
    assert np.all(np.diff(blocks.near[0] * len(curve) + blocks.near[1]) > 0)
    for a, b, c, d in blocks.ranges.T:
        i, j = blocks.tree.order[a:b, None], blocks.tree.order[None, c:d]
        apart = np.linalg.norm(curve.midpoints[i] - curve.midpoints[j], axis=-1)
        assert np.all(apart > 0.5 * (1 / theta - 1) * (curve.edge_lengths[i] + curve.edge_lengths[j]))


@CURVE
def test_only_near_pairs_can_be_left_out(curve: Curve) -> None:
    """Wherever among the pairs those would be that are not: the last two edges are neighbours, or of two components."""
    blocks, n = BlockList.of(curve, 0.25, 4), curve.mesh.edges
    listed = set(zip(blocks.near[0].tolist(), blocks.near[1].tolist(), strict=True))
    for i, j in ((0, 1), (n - 2, n - 1)):
        if (i, j) not in listed:
            with pytest.raises(OptionError, match="is not a near one"):
                blocks.near_pairs((np.array([i]), np.array([j])))


def test_a_list_is_of_one_mesh_only() -> None:
    curve = torus_trefoil(400)
    assert BlockList.of(curve, 0.25, 4).is_separated(curve, 0.25)
    assert not BlockList.of(curve, 0.25, 4).is_separated(opened(curve, 0), 0.25)


@CURVE
def test_clusters_halve_their_parents_and_are_parts_of_a_component_or_whole_ones(curve: Curve) -> None:
    tree = edge_clusters(curve, 4)
    assert sorted(tree.order) == list(range(curve.mesh.edges))
    component = curve.mesh.edge_component[tree.order]
    for start, stop in zip(tree.start, tree.stop, strict=True):
        held, count = np.unique(component[start:stop], return_counts=True)
        assert len(held) == 1 or np.array_equal(count, curve.mesh.edge_counts[held])
    for inner, child in tree.downward():
        np.testing.assert_array_equal(tree.start[inner], tree.start[child])
        np.testing.assert_array_equal(tree.stop[child], tree.start[child + 1])
        np.testing.assert_array_equal(tree.stop[inner], tree.stop[child + 1])
    leaves = tree.leaves()
    assert np.all((tree.stop - tree.start)[leaves] <= 4)
    np.testing.assert_array_equal(np.append(tree.start[leaves], curve.mesh.edges), np.append(0, tree.stop[leaves]))


def test_size_of_the_list_is_linear() -> None:
    one, twice = (BlockList.of(torus_trefoil(n), 0.25, 4) for n in (5_000, 10_000))
    assert len(twice.first) < 2.3 * len(one.first)
    assert len(twice.near[0]) < 2.3 * len(one.near[0])
    many, single = (BlockList.of(c, 0.5, 4) for c in (scattered_rings(2_000, 5, spread=60.0), torus_trefoil(10_000)))
    assert len(many.first) < 50 * len(single.first)
