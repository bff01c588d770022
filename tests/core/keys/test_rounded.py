"""Tubes for films: smooth, as thick as there is room, and proved."""

import numpy as np
import pytest
from mobius_flow.core import Curve
from mobius_flow.core.collision import is_free
from mobius_flow.core.curve import Mesh
from mobius_flow.core.keys.motion import Key, Keys
from mobius_flow.core.keys.tube import rounded, thickest_radius, tube_radii
from shapes import lattice_knot, regular_polygon


def sharpest(vertices):
    """Largest angle by which a closed polygon turns at a vertex, in degrees."""
    edges = np.roll(vertices, -1, axis=0) - vertices
    edges /= np.linalg.norm(edges, axis=1, keepdims=True)
    cosines = np.einsum("ij,ij->i", edges, np.roll(edges, -1, axis=0))
    return np.degrees(np.arccos(cosines.clip(-1, 1))).max()


def moving(vertices, keys=3):
    shapes = (vertices * (1.0 + 0.1 * k) for k in range(keys))
    return Keys(tuple(Key(float(k), shape.astype(np.float32)) for k, shape in enumerate(shapes)), 0)


def test_corners_are_rounded_and_the_motion_is_proved_anew():
    knot = lattice_knot("4_1")
    keys = moving(knot.vertices)
    _, round_ = rounded(knot.mesh, keys, is_free)
    assert round_.certified
    assert sharpest(knot.vertices) == pytest.approx(90)
    assert max(sharpest(key.points.astype(float)) for key in round_.keys) < 60
    assert [key.time for key in round_.keys] == [0.0, 1.0, 2.0]


def test_where_a_round_motion_is_not_proved_keys_keep_their_corners():
    knot = lattice_knot("4_1")
    keys = moving(knot.vertices, 6)
    _, exact = rounded(knot.mesh, keys, lambda *_: False)
    corners = [key.points.tobytes() for key in exact.keys]
    assert exact.unproved == 5
    refused = np.ptp(knot.vertices, axis=0).max() * 1.45

    def free(_mesh, _start, end):
        return np.ptp(end, axis=0).max() < refused or end.astype(np.float32).tobytes() in corners

    _, made = rounded(knot.mesh, keys, free)
    assert made.certified
    assert [key.points.tobytes() == corner for key, corner in zip(made.keys, corners, strict=True)] == 4 * [
        False
    ] + 2 * [True]


def test_what_was_not_proved_stays_so():
    knot = lattice_knot("3_1")
    keys = Keys(moving(knot.vertices).keys, 1)
    assert rounded(knot.mesh, keys, is_free)[1].unproved == 1


def test_a_fine_curve_and_an_open_one_keep_their_ends_and_their_places():
    arc = regular_polygon(1000).vertices[:600]
    mesh = Mesh((600,), (False,))
    made, keys = rounded(mesh, moving(arc, 1), is_free)
    assert made.closed == (False,)
    assert np.linalg.norm(keys.keys[0].points[[0, -1]] - arc[[0, -1]], axis=1).max() < 0.05


def test_tubes_are_thin_only_where_others_are_near():
    """Two rings one above the other, one of them bent down to the other at one place."""
    ring = regular_polygon(400).vertices
    bent = ring + np.array([0.0, 0.0, 1.0])
    bent[:, 2] -= 0.96 * np.exp(-((ring[:, 0] - ring[:, 0].max()) ** 2) / 0.02)
    curve = Curve.from_components([ring, bent])
    (radii,) = tube_radii(curve.mesh, [curve.vertices], np.zeros(1))
    narrow = ring[:, 0].argmax()
    assert radii[narrow] < 0.022
    assert radii[ring[:, 0].argmin()] == pytest.approx(thickest_radius(curve))
    assert np.abs(np.diff(radii[:400])).max() <= 0.0801 * curve.edge_lengths.max()


def test_tubes_become_thin_before_and_thick_after_a_narrow_place_at_the_same_pace():
    ring = regular_polygon(60).vertices
    curves = [
        Curve.from_components([ring, ring + np.array([0.0, 0.0, d])]) for d in (1.0, 1.0, 1.0, 0.06, 1.0, 1.0, 1.0)
    ]
    points = [curve.vertices.astype(np.float32) for curve in curves]
    radii = tube_radii(curves[0].mesh, [p.astype(float) for p in points], np.arange(7.0) * 2.0).max(axis=1)
    assert 0.0 < radii.min() == radii[3] < 0.031
    np.testing.assert_allclose(radii, radii[::-1], rtol=1e-6)
    steps = np.abs(np.diff(np.log(radii)))
    assert steps.min() > 0
    assert steps.max() <= np.log(1.0 + 2.0 * 0.15) + 1e-9


def test_tubes_are_never_too_thin_to_see():
    ring = regular_polygon(60).vertices
    curve = Curve.from_components([ring, ring + np.array([0.0, 0.0, 1e-6])])
    radii = tube_radii(curve.mesh, [curve.vertices], np.zeros(1))
    assert radii.max() == pytest.approx(4e-3 * np.ptp(ring, axis=0).max(), rel=1e-5)


def test_tubes_are_not_much_thicker_elsewhere_where_many_strands_are_close():
    """A long ring, and a stack of rings inside that are close to each other."""
    ring = regular_polygon(100).vertices
    stack = [0.2 * ring + np.array([0.0, 0.0, 0.02 * k]) for k in range(4)]
    curve = Curve.from_components([3.0 * ring, *stack])
    radii = tube_radii(curve.mesh, [curve.vertices], np.zeros(1))[0]
    assert radii[:100].max() <= 2.2 * np.quantile(radii[100:], 0.5) < thickest_radius(curve)
