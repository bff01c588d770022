"""Corners of polygons rounded."""

import numpy as np
import pytest
from mobius_flow.core import Curve, knots
from mobius_flow.core.collision import is_free
from mobius_flow.core.curve.refine import subdivide


def sharpest(curve):
    """The largest angle between an edge and the next, in degrees."""
    edges = np.diff(curve.components[0], axis=0)
    edges /= np.linalg.norm(edges, axis=1, keepdims=True)
    return np.degrees(np.arccos(np.clip((edges[1:] * edges[:-1]).sum(axis=1), -1, 1))).max()


@pytest.mark.parametrize("name", ["goeritz", "thistlethwaite", "3_1", "L6a4", "overhand"])
def test_corners_are_rounded_by_a_free_motion(name):
    curve = knots.knot(name)
    round_ = knots.rounded(curve)
    assert len(round_) >= 320
    assert sharpest(round_) < 0.4 * sharpest(curve)
    split = subdivide(curve, np.full(curve.mesh.edges, round_.mesh.edges // curve.mesh.edges))
    assert is_free(split.mesh, split.vertices, round_.vertices)
    np.testing.assert_array_equal(round_.vertices[round_.mesh.ends], split.vertices[split.mesh.ends])


def test_a_corner_that_holds_another_strand_stays_around_it():
    corner = [[0, 0, 0], [10, 1, 0], [10, -1, 0]]
    held = [[0.5, 0, -1], [0.5, 0, 1], [-5, 0, 1], [-5, 0, -1]]
    link = Curve.from_components([corner, held])
    assert str(knots.knot_type(knots.rounded(link))) == str(knots.knot_type(link)) == "L2a1"
