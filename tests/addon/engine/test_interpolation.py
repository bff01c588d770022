"""Values in between: along splines, on refined polygons, between keys."""

import numpy as np
import pytest
from mobius_flow.addon.engine.interpolation import along, interpolated, on_refined
from mobius_flow.core.curve import refine
from mobius_flow.core.knots import overhand
from shapes import hopf_link, torus_trefoil


@pytest.mark.parametrize("curve", [torus_trefoil(20), hopf_link(12), overhand(40)], ids=["knot", "link", "arc"])
@pytest.mark.parametrize("vertices", [77, 133])
def test_coordinates_of_refined_vertices_lie_between_those_of_corners(curve, vertices):
    refined = refine(curve, vertices)
    for k, closed in enumerate(curve.mesh.closed):
        lengths, finer = (each.edge_lengths[each.mesh.edge_slices[k]] for each in (curve, refined))
        for old, new in zip(curve.components[k].T, refined.components[k].T, strict=True):
            np.testing.assert_allclose(on_refined(old, lengths, finer, closed), new, atol=1e-12)


@pytest.mark.parametrize("curve", [torus_trefoil(40), overhand(40)], ids=["knot", "arc"])
def test_a_curve_that_was_fine_enough_is_left_alone(curve):
    values, lengths = np.arange(40.0), curve.edge_lengths
    np.testing.assert_array_equal(on_refined(values, lengths, lengths, curve.mesh.closed[0]), values)


def test_values_lie_evenly_along_what_is_drawn():
    values = np.array([1.0, 2.0, 4.0], dtype=np.float32)
    np.testing.assert_allclose(along(values, 6, closed=True), [1, 1.5, 2, 3, 4, 2.5])
    np.testing.assert_allclose(along(values, 5, closed=False), [1, 1.5, 2, 3, 4])


def test_shapes_between_keys_are_straight():
    values = np.array([[0.0, 1.0], [2.0, 1.0], [2.0, 5.0]])
    np.testing.assert_allclose(
        interpolated(values, np.array([0.25, 1.0, 1.5, 2.0])), [[0.5, 1], [2, 1], [2, 3], [2, 5]]
    )
    np.testing.assert_array_equal(interpolated(values[:1], np.zeros(1)), values[:1])
