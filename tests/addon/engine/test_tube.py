"""How thick a tube may be: the nearest strands, found without looking at all pairs of points."""

import numpy as np
import pytest
from mobius_flow.addon.engine.tube import _DISTINCT, _nearest_strands, free_radius, thickest_radius
from mobius_flow.core import Curve
from mobius_flow.core.curve import refine
from mobius_flow.core.curve.distances import arc_distance_of_pairs
from mobius_flow.core.knots import knot
from shapes import hopf_link, regular_polygon


def of_all_pairs(curve, furthest):
    i, j = np.triu_indices(len(curve), 1)
    distance = np.linalg.norm(curve.vertices[i] - curve.vertices[j], axis=1)
    distance = distance[(arc_distance_of_pairs(curve, i, j) > _DISTINCT * distance) & (distance <= furthest)]
    return distance.min() if distance.size else None


@pytest.mark.parametrize("name", ["3_1", "8_19", "T(7,8)", "L6a4"])
def test_the_nearest_strands_are_those_of_all_pairs(name):
    curve = knot(name)
    for furthest in (0.5, 5.0) * np.array(thickest_radius(curve)):
        assert _nearest_strands(curve, furthest) == of_all_pairs(curve, furthest)


def test_unequal_edges_do_not_matter():
    link = hopf_link(30)
    curve = Curve.from_components([refine(Curve(link.components[0]), 500).vertices, link.components[1][::3]])
    assert _nearest_strands(curve, 10.0) == of_all_pairs(curve, 10.0)


def test_where_there_is_room_the_tube_is_as_thick_as_looks_right():
    circle = regular_polygon(100)
    thickest = thickest_radius(circle)
    assert free_radius(circle, thickest) == thickest
