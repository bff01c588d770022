"""The nearest strands, found without looking at all pairs of vertices."""

import numpy as np
import pytest
from mobius_flow.core import Curve
from mobius_flow.core.curve import refine
from mobius_flow.core.curve.distances import arc_distance_of_vertices, nearest_strands
from mobius_flow.core.knots import knot, overhand
from shapes import hopf_link, regular_polygon

RATIO = 3.0


def of_all_pairs(curve: Curve, furthest: float = np.inf) -> float:
    i, j = np.triu_indices(len(curve), 1)
    distance = np.linalg.norm(curve.vertices[i] - curve.vertices[j], axis=1)
    chosen = (arc_distance_of_vertices(curve, i, j) > RATIO * distance) & (distance <= furthest)
    return float(distance[chosen].min(initial=np.inf))


@pytest.mark.parametrize("name", ["3_1", "8_19", "T(7,8)", "L6a4", "overhand"])
def test_they_are_those_of_all_pairs(name: str) -> None:
    curve = knot(name)
    for furthest in (0.01 * curve.length, 0.1 * curve.length, np.inf):
        assert nearest_strands(curve, RATIO, furthest) == of_all_pairs(curve, furthest)


def test_unequal_edges_do_not_matter() -> None:
    link = hopf_link(30)
    curve = Curve.from_components([refine(Curve(link.components[0]), 500).vertices, link.components[1][::3]])
    assert nearest_strands(curve, RATIO) == of_all_pairs(curve)


def test_circles_vertices_that_coincide_and_arcs() -> None:
    """A circle has no other strand, most edges may have no length, and arcs have a vertex more than edges."""
    assert nearest_strands(regular_polygon(100), RATIO) == np.inf
    doubled = np.repeat(np.array([[0.0, 0.0, 0.0], [9.0, 0.0, 0.0], [9.0, 9.0, 0.0], [0.0, 9.0, 0.0]]), 3, axis=0)
    curve = Curve.from_components([doubled, doubled + np.array([0.0, 0.0, 1.0])])
    assert nearest_strands(curve, RATIO) == 1.0
    link = Curve.from_components([hopf_link(30).components[0] + 2.0, overhand(90).vertices], (True, False))
    assert nearest_strands(link, RATIO) == of_all_pairs(link)
