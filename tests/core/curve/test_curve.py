"""Polygons and their connectivity."""

import copy
import pickle

import numpy as np
import pytest
from mobius_flow.core import Curve, CurveError, Mesh
from shapes import hopf_link


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
