"""More keys where a curve turns far from one to the next, so that its tube stays as thick as it is."""

import numpy as np
import pytest
from mobius_flow.addon.engine.in_between import interpolated, places_between
from mobius_flow.addon.engine.ribbon import tangents
from mobius_flow.addon.engine.tube_mesh import rings
from mobius_flow.core.curve import Mesh
from shapes import regular_polygon, torus_trefoil


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


def test_a_curve_that_turns_inside_out_gets_so_many_and_no_more():
    points = turning(np.pi)
    assert 3 < len(places_between(points, Mesh((60,)))) <= 33


def test_one_shape_is_one_key():
    points = torus_trefoil(20).vertices[None]
    np.testing.assert_array_equal(places_between(points, Mesh((20,))), [0.0])
    np.testing.assert_array_equal(interpolated(points, np.zeros(1)), points)


def test_values_in_between_are_straight():
    values = np.array([[0.0, 1.0], [2.0, 1.0], [2.0, 5.0]])
    np.testing.assert_allclose(
        interpolated(values, np.array([0.25, 1.0, 1.5, 2.0])), [[0.5, 1], [2, 1], [2, 3], [2, 5]]
    )
