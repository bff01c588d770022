"""Curves as values, and their lengths."""

import copy
import itertools
import pickle

import numpy as np
import pytest
from mobius_flow.core import Curve, CurveError, Mesh, RelaxOptions, Status, minimize
from shapes import hopf_link, torus_trefoil


@pytest.mark.parametrize(
    "again", [lambda value: value, copy.copy, copy.deepcopy, lambda value: pickle.loads(pickle.dumps(value))]
)
def test_values_and_their_copies_are_read_only(again):
    link = hopf_link(10)
    assert link.mesh.heads[0] == 1
    assert link.edge_lengths[0] > 0
    same = again(link)
    np.testing.assert_array_equal(same.vertices, link.vertices)
    assert same.mesh == link.mesh
    for array in (same.vertices, same.edge_lengths, same.midpoints, same.mesh.heads, again(link.mesh).heads):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1


def test_the_input_is_copied_and_comes_back():
    points = np.array(hopf_link(10).vertices)
    curve = Curve.from_components(np.split(points, 2))
    points[0] = 9
    np.testing.assert_array_equal(np.concatenate(curve.components), hopf_link(10).vertices)
    assert curve.mesh.component_sizes == (10, 10)


@pytest.mark.parametrize(
    ("vertices", "message"),
    [
        ([[0, 0, 0], [1, 0, 0]], "component 1 has 2 vertices"),
        ([[0, 0, 0], [1, 0, 0], [np.nan, 1, 0]], "vertex 3 is not finite"),
        ([[0, 0, 0], [1, 0, np.inf], [0, 1, 0]], "vertex 2 is not finite"),
        ([0, 1, 2], "shape"),
        ([[0], [1], [2]], "at least 2"),
        ("abc", "vertices cannot be made an array .* of real numbers: could not convert"),
        ([[1, 2], [3]], "vertices cannot be made an array .* of real numbers: setting an array element"),
        ([[1, 2j], [3, 4], [5, 6]], "vertices cannot be made .* real numbers: they are complex"),
        ([[10**400, 1], [3, 4], [5, 6]], "vertices cannot be made"),
    ],
)
def test_bad_vertices(vertices, message):
    with pytest.raises(CurveError, match=message):
        Curve(vertices)


def test_bad_components():
    with pytest.raises(CurveError, match="component 2 has shape"):
        Curve.from_components([np.zeros((3, 3)), np.zeros((3, 2))])
    with pytest.raises(CurveError, match="component 2 cannot be made an array"):
        Curve.from_components([np.eye(3), "ring"])
    with pytest.raises(CurveError, match="it has no component"):
        Mesh(())
    with pytest.raises(CurveError, match=r"mesh is of type tuple; give a Mesh, such as Mesh\(\(3,\)\)"):
        Curve(np.eye(3), (3,))


@pytest.mark.parametrize("sizes", [5, None, (4.0,), ("4",), ((4,),)])
def test_component_sizes_that_are_none(sizes):
    with pytest.raises(CurveError, match="it must be a tuple of whole numbers"):
        Mesh(sizes)
    assert list(map(type, Mesh(list(np.array([3, 4]))).component_sizes)) == [int, int]


def uneven_circle():
    """A circle whose longest edge is four times the shortest; only that is left to mend."""
    gaps = 1 + 0.6 * np.cos(2 * np.pi * np.arange(60) / 60)
    t = 2 * np.pi * np.cumsum(gaps) / gaps.sum()
    return Curve(np.stack([np.cos(t), np.sin(t)], axis=1))


@pytest.mark.parametrize("method", ["lbfgs", "trust-region", "flow-moebius", "implicit-moebius"])
def test_unequal_edges_become_equal(method):
    result = minimize(torus_trefoil(70), RelaxOptions(method=method, max_iterations=25, vertices=70))
    assert result.last.edge_length_error < 1e-8


@pytest.mark.parametrize("method", ["lbfgs", "cg", "flow-moebius", "flow-h1"])
def test_lengths_do_not_creep_where_nothing_is_left_to_gain(method):
    """Steps may miss their prediction there, which is next to nothing; otherwise they are halved again and again."""
    result = minimize(uneven_circle(), RelaxOptions(method=method, vertices=60))
    assert result.status is Status.CONVERGED
    assert result.last.edge_length_error < 1e-8
    assert len(result.energies) < 40


def test_energy_spent_on_edge_lengths_is_told_of():
    """A circle with uneven edges has nothing to gain, and in L² lengths change in rough motions."""
    iterates = []
    result = minimize(uneven_circle(), RelaxOptions(method="flow-l2", max_iterations=10, vertices=60), iterates.append)
    rises = [b.energy - a.energy for a, b in itertools.pairwise(iterates) if b.energy > a.energy * (1 + 1e-9)]
    assert len(rises) > 3
    told = f"the energy rose in {len(rises)} of {iterates[-1].index} steps, by {sum(rises):.3g} in total"
    assert told in result.message
    assert iterates[-1].edge_length_error < iterates[0].edge_length_error
    assert "rose" not in minimize(torus_trefoil(60), RelaxOptions(max_iterations=5)).message


def test_a_direction_without_length_is_tried_all_the_same():
    """In L² nothing of a triangle's gradient is left beside the lengths, which are off their targets still."""
    corners = [[0.12573022, -0.13210486], [0.64042265, 0.10490012], [-0.53566937, 0.36159505]]
    triangle, options = Curve(np.array(corners)), RelaxOptions(method="flow-l2", vertices=3, max_iterations=2)
    result = minimize(triangle, options)
    assert result.status is Status.CONVERGED
    assert result.last.gradient_norm == 0.0
    assert result.last.edge_length_error < 1e-6
