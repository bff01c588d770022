"""Lists of near pairs and far blocks, and what a sample of pairs tells of the error of expansions."""

from functools import cache
from itertools import combinations

import numpy as np
import pytest
from hard_curves import bent_trefoil
from mobius_flow.core import Curve, OptionError
from mobius_flow.core.curve.refine import refine, subdivide
from mobius_flow.core.driver import RelaxOptions
from mobius_flow.core.driver.prepare import start_problem
from mobius_flow.core.energies.barrier import replaced_pairs
from mobius_flow.core.energies.hierarchy import BlockList, HierarchicalMoebiusEnergy, SampledErrors, moebius_energy
from mobius_flow.core.energies.hierarchy.blocks import edge_clusters
from mobius_flow.core.energies.hierarchy.energy import Estimate, energy_error, slope_error
from mobius_flow.core.knots import knot
from shapes import chain_of_rings, graded_trefoil, hopf_link, opened, regular_polygon, scattered_rings, torus_trefoil
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


def multiplicity(blocks):
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
def test_every_pair_of_edges_exactly_once_and_far_ones_alone_in_blocks(curve, theta, leaf):
    blocks, edge = BlockList.of(curve, theta, leaf), np.arange(curve.mesh.edges)
    np.testing.assert_array_equal(multiplicity(blocks), curve.mesh.disjoint(edge[:, None], edge[None, :]))
    assert np.all(blocks.near[0] < blocks.near[1])
    assert np.all(np.diff(blocks.near[0] * len(curve) + blocks.near[1]) > 0)
    for a, b, c, d in blocks.ranges.T:
        i, j = blocks.tree.order[a:b, None], blocks.tree.order[None, c:d]
        apart = np.linalg.norm(curve.midpoints[i] - curve.midpoints[j], axis=-1)
        assert np.all(apart > 0.5 * (1 / theta - 1) * (curve.edge_lengths[i] + curve.edge_lengths[j]))


@CURVE
def test_only_near_pairs_can_be_left_out(curve):
    """Wherever among the pairs those would be that are not: the last two edges are neighbours, or of two components."""
    blocks, n = BlockList.of(curve, 0.25, 4), curve.mesh.edges
    listed = set(zip(blocks.near[0].tolist(), blocks.near[1].tolist(), strict=True))
    for i, j in ((0, 1), (n - 2, n - 1)):
        if (i, j) not in listed:
            with pytest.raises(OptionError, match="is not a near one"):
                blocks.near_pairs((np.array([i]), np.array([j])))


def test_a_list_is_of_one_mesh_only():
    curve = torus_trefoil(400)
    assert BlockList.of(curve, 0.25, 4).is_separated(curve, 0.25)
    assert not BlockList.of(curve, 0.25, 4).is_separated(opened(curve, 0), 0.25)


@CURVE
def test_clusters_halve_their_parents_and_are_parts_of_a_component_or_whole_ones(curve):
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


def test_size_of_the_list_is_linear():
    one, twice = (BlockList.of(torus_trefoil(n), 0.25, 4) for n in (5_000, 10_000))
    assert len(twice.first) < 2.3 * len(one.first)
    assert len(twice.near[0]) < 2.3 * len(one.near[0])
    many, single = (BlockList.of(c, 0.5, 4) for c in (scattered_rings(2_000, 5, spread=60.0), torus_trefoil(10_000)))
    assert len(many.first) < 50 * len(single.first)


LARGE = {
    "smooth": bent_trefoil(1500),
    "tangle": subdivide(refine(knot("ochiai-1"), 300), np.full(300, 4)),
    "table": refine(knot("goeritz"), 1000),
    "graded": graded_trefoil(1500, 20.0),
    "links": chain_of_rings(20, (60, 90)),
}
NAME = pytest.mark.parametrize("name", LARGE)


@cache
def point(name):
    options = RelaxOptions(solver="hierarchical", mesh="fixed", vertices=len(LARGE[name]))
    return start_problem(LARGE[name], options).at_curve(LARGE[name])


@cache
def energy(name):
    """The energy that a run looks at there."""
    curve = point(name).curve
    return HierarchicalMoebiusEnergy(without=replaced_pairs(curve)).frozen_at(curve)


@cache
def true_errors(name):
    """Of the energy and of its derivative along the projected gradient."""
    curve = point(name).curve
    value, derivative = energy(name).value_and_derivative(curve)
    exact, exact_derivative = energy(name).exact.value_and_derivative(curve)
    return value - exact, float(np.sum((derivative - exact_derivative) * point(name).gradient))


@NAME
def test_rows_add_up(name):
    curve = point(name).curve
    pairs = energy(name).exact.value(curve) - 4.0 * len(curve.mesh.component_sizes)
    rows = energy(name).exact.row_energies(curve, np.arange(len(curve)))
    assert rows.sum() == pytest.approx(pairs, rel=1e-12)
    fast = energy(name).row_energies(curve, np.arange(len(curve)))
    np.testing.assert_allclose(fast, rows, atol=1e-4 * np.abs(rows).max())
    assert fast.sum() == pytest.approx(energy(name).value(curve) - 4.0 * len(curve.mesh.component_sizes), rel=1e-12)


@NAME
@pytest.mark.parametrize("count", [100, 512, 10_000])
def test_errors_are_within_three_standard_errors_of_what_a_sample_tells(name, count):
    """A sample of all edges tells the errors themselves."""
    curve, (of_energy, of_slope) = point(name).curve, true_errors(name)
    for estimate, true in (
        (energy_error(energy(name), curve, count), of_energy),
        (slope_error(energy(name), curve, point(name).gradient, count), of_slope),
    ):
        rounding = 1e-8 * abs(point(name).energy)
        assert count < len(curve) or estimate.standard_error == 0.0
        assert abs(estimate.mean - true) < 3.0 * estimate.standard_error + rounding
        assert abs(true) < estimate.bound + rounding


@NAME
def test_by_default_a_sample_tells_the_errors_that_are_wanted_by_default(name):
    """Its standard errors are a third of them at most, so that they are what decides."""
    at = point(name)
    errors = SampledErrors.at(energy(name), at.curve, at.energy, at.gradient, at.gradient_norm)
    assert errors.energy.standard_error < 3e-7
    assert errors.gradient_norm.standard_error < 1.5e-5
    assert errors.within(1e-4)
    assert not errors.within(1e-12)


@pytest.mark.parametrize("count", [2, 4, 6])
def test_standard_errors_are_those_of_samples_without_replacement(count):
    """Squared and averaged over all samples of six numbers they are the variance of the sum that is told."""
    numbers = np.array([1.0, -2.0, 4.0, 0.5, 3.0, 9.0])
    told = [Estimate.of_sum(numbers[list(chosen)], 6, rest=5.0) for chosen in combinations(range(6), count)]
    assert np.mean([each.mean for each in told]) == pytest.approx(5.0 + numbers.sum())
    variance = np.var([each.mean for each in told])
    assert np.mean([each.standard_error**2 for each in told]) == pytest.approx(variance, abs=1e-12)


def test_the_reported_energy_says_its_error_where_it_is_not_exact(monkeypatch):
    curve = bent_trefoil(2000)
    exact, error = moebius_energy(curve)
    assert error == 0.0
    monkeypatch.setattr("mobius_flow.core.energies.hierarchy.energy.EXACT_UP_TO", 1000)
    value, bound = moebius_energy(curve)
    assert 0.0 < abs(value - exact) < bound * value < 1e-6 * value
