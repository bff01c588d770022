"""Values at points of a refined polygon."""

import numpy as np
from mobius_flow.addon.engine.refinement import along, places
from mobius_flow.core.curve import refine
from mobius_flow.core.knots import overhand
from shapes import hopf_link, torus_trefoil


def test_corners_keep_their_values_and_others_lie_between():
    original = torus_trefoil(20)
    refined = refine(original, 77)
    (place,) = places(original, refined)
    heads = np.roll(original.vertices, -1, axis=0)
    for axis in range(3):
        found = place.values(original.vertices[:, axis])
        np.testing.assert_allclose(found, refined.vertices[:, axis], atol=1e-12)
    straight = original.vertices[place.edge] + place.fraction[:, None] * (heads - original.vertices)[place.edge]
    np.testing.assert_allclose(straight, refined.vertices, atol=1e-12)


def test_each_component_by_itself():
    original = hopf_link(12)
    refined = refine(original, 60)
    for k, place in enumerate(places(original, refined)):
        assert len(place.edge) == refined.mesh.component_sizes[k]
        assert place.edge.max() < 12


def test_a_curve_that_was_fine_enough_is_left_alone():
    original = torus_trefoil(30)
    (place,) = places(original, original)
    np.testing.assert_array_equal(place.values(np.arange(30.0)), np.arange(30.0))


def test_an_arc_keeps_the_values_of_its_ends():
    original = overhand(40)
    refined = refine(original, 133)
    (place,) = places(original, refined)
    assert len(place.edge) == 133
    assert (place.edge[-1], place.fraction[-1]) == (38, 1.0)
    for axis in range(3):
        np.testing.assert_allclose(place.values(original.vertices[:, axis]), refined.vertices[:, axis], atol=1e-12)


def test_values_lie_evenly_along_what_is_drawn():
    values = np.array([1.0, 2.0, 4.0], dtype=np.float32)
    np.testing.assert_allclose(along(values, 6, closed=True), [1, 1.5, 2, 3, 4, 2.5])
    np.testing.assert_allclose(along(values, 5, closed=False), [1, 1.5, 2, 3, 4])
