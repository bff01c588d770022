"""Values in between: along splines, on refined polygons, between keys."""

import numpy as np
import pytest
from mobius_flow.core import Mesh
from mobius_flow.core.curve import interpolated, refine
from mobius_flow.core.curve.tube import places_between, rings, tangents
from mobius_flow.core.keys.markers import along, on_refined
from mobius_flow.core.knots import overhand
from shapes import hopf_link, regular_polygon, torus_trefoil


@pytest.mark.parametrize("curve", [torus_trefoil(20), hopf_link(12), overhand(40)], ids=["knot", "link", "arc"])
@pytest.mark.parametrize("vertices", [77, 133])
def test_coordinates_of_refined_vertices_lie_between_those_of_corners(curve, vertices):
    refined = refine(curve, vertices)
    for k, closed in enumerate(curve.mesh.closed):
        lengths, finer = (each.edge_lengths[each.mesh.edge_slices[k]] for each in (curve, refined))
        for old, new in zip(curve.components[k].T, refined.components[k].T, strict=True):
            np.testing.assert_allclose(on_refined(old, lengths, finer, closed), new, atol=1e-12)
            np.testing.assert_array_equal(on_refined(old, lengths, lengths, closed), old)  # where it was fine enough


def test_values_lie_evenly_along_what_is_drawn_and_shapes_between_keys_are_straight():
    values = np.array([1.0, 2.0, 4.0], dtype=np.float32)
    np.testing.assert_allclose(along(values, 6, closed=True), [1, 1.5, 2, 3, 4, 2.5])
    np.testing.assert_allclose(along(values, 5, closed=False), [1, 1.5, 2, 3, 4])
    values = np.array([[0.0, 1.0], [2.0, 1.0], [2.0, 5.0]])
    np.testing.assert_allclose(
        interpolated(values, np.array([0.25, 1.0, 1.5, 2.0])), [[0.5, 1], [2, 1], [2, 3], [2, 5]]
    )
    np.testing.assert_array_equal(interpolated(values[:1], np.zeros(1)), values[:1])
    zeros = np.array([-0.0, 1.0, -0.0])  # values that are hit stay bit for bit
    assert interpolated(zeros, np.array([0.0, 1.0])).tobytes() == zeros[:2].tobytes()


def turning(angle, n=60):
    """A circle that moves to the same one turned about an axis in its plane."""
    start = regular_polygon(n).vertices + np.array([0.0, 0.0, 2.0])
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([start, start @ np.array([[1, 0, 0], [0, c, -s], [0, s, c]]).T])


def thinnest(points, radius=0.1, sides=8):
    """Least distance of the tube's vertices from the curve, at the keys and halfway between them."""
    mesh = Mesh((points.shape[1],))
    shapes = rings(points, np.full(points.shape[:2], radius), mesh, sides).reshape(len(points), -1, sides, 3)
    shapes, middles = (interpolated(x, np.arange(0, len(points) - 0.75, 0.5)) for x in (shapes, points))
    return np.linalg.norm(shapes - middles[:, :, None], axis=-1).min()


@pytest.mark.parametrize("degrees", [40, 90, 140])
def test_the_tube_stays_thick(degrees):
    points = turning(np.radians(degrees))
    places = places_between(points, Mesh((60,)))
    finer = interpolated(points, places)
    cosines = np.einsum("kni,kni->kn", *(tangents(x) for x in (finer[:-1], finer[1:])))
    assert cosines.min() >= np.cos(np.radians(30)) - 1e-12
    assert thinnest(finer) > 0.096
    assert thinnest(points) < thinnest(finer)


def test_keys_stay_and_small_turns_need_no_more():
    points = np.stack([torus_trefoil(50).vertices * scale for scale in (1.0, 1.1, 1.2)])
    np.testing.assert_array_equal(places_between(points, Mesh((50,))), [0, 1, 2])
    places = places_between(np.concatenate([turning(0.1), turning(2.0)[1:]]), Mesh((60,)))
    assert {0.0, 1.0, 2.0} < set(places)
    assert not ((places > 0) & (places < 1)).any()
    inside_out = turning(np.pi)
    assert 3 < len(places_between(inside_out, Mesh((60,)))) <= 33
    np.testing.assert_array_equal(places_between(inside_out[:1], Mesh((60,))), [0.0])
