"""Tubes: as thick as there is room, smooth in films, and proved."""

from itertools import pairwise

import numpy as np
import pytest
from mobius_flow.core import Curve, Mesh, Obstacle, RelaxOptions, minimize
from mobius_flow.core.collision import is_rope
from mobius_flow.core.curve.distances import nearest_strands
from mobius_flow.core.curve.refine import evenly
from mobius_flow.core.keys.key_options import Pace, Timing
from mobius_flow.core.keys.markers import corners
from mobius_flow.core.keys.motion import recorded
from mobius_flow.core.keys.placement import Measure
from mobius_flow.core.keys.recording import Key, Keys, Kind
from mobius_flow.core.keys.tube import (
    free_radius,
    radius_beside,
    rope_radii,
    rounded,
    strand_gap,
    thickest_radius,
    tube_radii,
)
from mobius_flow.core.knots import knot, smooth_knot
from recorded_motions import followed, iterate
from scipy.spatial.distance import pdist, squareform
from shapes import lattice_knot, regular_polygon

RING = regular_polygon(60).vertices


@pytest.mark.parametrize("n", [150, 600])
def test_a_tube_is_thinner_where_the_curve_bends_on_its_scale(n):
    """Waves round a ring, whose bends have a radius of 0.08: the tube would be a row of lumps."""
    angles = np.linspace(0.0, 2.0 * np.pi, n, endpoint=False)
    away = 1.0 + 0.03 * np.cos(20 * angles)
    curve = Curve(np.stack([away * np.cos(angles), away * np.sin(angles), 0.0 * angles], axis=1))
    radius = free_radius(curve, thickest_radius(curve))
    assert 0.5 * thickest_radius(curve) <= radius < 0.8 * thickest_radius(curve)
    large = Curve(3.0 * curve.vertices)
    assert free_radius(large, thickest_radius(large)) == pytest.approx(3.0 * radius, rel=0.01)


@pytest.mark.parametrize("n", [4, 100])
def test_where_there_is_room_the_tube_is_as_thick_as_looks_right_and_corners_make_none_thinner(n):
    curve = regular_polygon(n)
    assert free_radius(curve, thickest_radius(curve)) == thickest_radius(curve)


@pytest.mark.parametrize(
    ("depth", "least", "most"),
    [(0.2, 0.1, 0.1), (None, 0.1, 0.1), (1e-9, 0.97e-4, 1.03e-4)]
    + [(depth, 0.97 * 0.94 * depth, 0.94 * depth) for depth in (0.09, 0.03, 0.004)],
)
def test_obstacles_leave_as_much_room_as_there_is_and_a_tube_can_always_be_drawn(depth, least, most):
    corners = [(-9, -9), (9, -9), (9, 9), (-9, 9)]
    floor = [Obstacle([(*each, -depth) for each in corners], [(0, 1, 2), (0, 2, 3)])] if depth else []
    assert least <= radius_beside(regular_polygon(100), 0.1, floor) <= most


@pytest.mark.parametrize("pieces", [2, 10, 100])
def test_strands_side_by_side_have_a_gap_however_long_their_edges_are(pieces):
    """Edges may be nearer to each other than their ends, but where these lie side by side they are not."""
    x = np.linspace(-1.0, 1.0, pieces + 1)
    strands = [np.stack([x, 0 * x, 0 * x + z], axis=1) for z in (0.0, 0.1)]
    gap = strand_gap(Curve.from_components(strands, (False, False)), 2.0)
    assert gap + 1e-12 >= 0.05
    assert gap <= 0.1


@pytest.mark.parametrize(("name", "flat"), [("3_1", 1.0), ("10_165", 0.3), ("L6a4", 0.02), ("10_165", 0.02)])
def test_some_of_the_vertices_tell_gaps_as_all_do(name, flat):
    knot = smooth_knot(name, 3000)
    knot = knot.with_vertices(knot.vertices * [1.0, 1.0, flat])
    widest = 2.0 * thickest_radius(knot)
    nearest = np.sqrt(nearest_strands(knot, 3.0, widest) ** 2 - 0.25 * knot.edge_lengths.max() ** 2)
    assert min(strand_gap(knot, widest), widest) == pytest.approx(min(nearest, widest), rel=0.01)


def sharpest(vertices):
    """Largest angle by which a closed polygon turns at a vertex, in degrees."""
    edges = np.roll(vertices, -1, axis=0) - vertices
    edges /= np.linalg.norm(edges, axis=1, keepdims=True)
    cosines = np.einsum("ij,ij->i", edges, np.roll(edges, -1, axis=0))
    return np.degrees(np.arccos(cosines.clip(-1, 1))).max()


def moving(vertices, keys, unproved=0):
    shapes = (vertices * (1.0 + 0.1 * k) for k in range(keys))
    return Keys(tuple(Key(float(k), shape.astype(np.float32)) for k, shape in enumerate(shapes)), unproved)


@pytest.mark.parametrize("unproved", [0, 1])
def test_corners_are_rounded_and_the_motion_is_proved_anew(unproved):
    knot = lattice_knot("4_1")
    _, keys = rounded(knot.mesh, moving(knot.vertices, 3, unproved), is_rope)
    assert keys.unproved == unproved
    assert sharpest(knot.vertices) == pytest.approx(90)
    assert max(sharpest(key.points.astype(float)) for key in keys.keys) < 60
    assert [key.time for key in keys.keys] == [0.0, 1.0, 2.0]


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
    same = [key.points.tobytes() == corner for key, corner in zip(made.keys, corners, strict=True)]
    assert same == 4 * [False] + 2 * [True]


def test_a_fine_curve_and_an_open_one_keep_their_ends_and_their_places():
    arc = regular_polygon(1000).vertices[:600]
    made, keys = rounded(Mesh((600,), (False,)), moving(arc, 1), is_rope)
    assert made.closed == (False,)
    assert np.linalg.norm(keys.keys[0].points[[0, -1]] - arc[[0, -1]], axis=1).max() < 0.05


def radii_of(curves, frames):
    return tube_radii(curves[0].mesh, [curve.vertices for curve in curves], np.array(frames, dtype=float))


def test_tubes_are_thin_only_where_others_are_near():
    ring = regular_polygon(400).vertices
    bent = ring + np.array([0.0, 0.0, 1.0])
    bent[:, 2] -= 0.96 * np.exp(-((ring[:, 0] - ring[:, 0].max()) ** 2) / 0.02)
    curve = Curve.from_components([ring, bent])
    (radii,) = radii_of([curve], [0])
    assert radii[ring[:, 0].argmax()] < 0.022
    assert radii[ring[:, 0].argmin()] == pytest.approx(thickest_radius(curve))
    assert np.abs(np.diff(radii[:400])).max() <= 0.0801 * curve.edge_lengths.max()


def test_tubes_become_thin_before_and_thick_after_a_narrow_place_at_the_same_pace():
    apart = (1.0, 1.0, 1.0, 0.06, 1.0, 1.0, 1.0)
    curves = [Curve.from_components([RING, RING + np.array([0.0, 0.0, d])]) for d in apart]
    radii = radii_of(curves, 2.0 * np.arange(7)).max(axis=1)
    assert 0.0 < radii.min() == radii[3] < 0.031
    np.testing.assert_allclose(radii, radii[::-1], rtol=1e-6)
    steps = np.abs(np.diff(np.log(radii)))
    assert steps.min() > 0
    assert steps.max() <= np.log(1.0 + 2.0 * 0.15) + 1e-9


def test_tubes_are_never_too_thin_to_see():
    curve = Curve.from_components([RING, RING + np.array([0.0, 0.0, 1e-6])])
    assert radii_of([curve], [0]).max() == pytest.approx(4e-3 * np.ptp(RING, axis=0).max(), rel=1e-5)


def crowding(vertices, radius):
    """Least distance of points of a closed polygon that are a bit more than half a circle apart along it, in widths."""
    points = evenly(vertices, True, 400)
    steps = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
    along = np.abs(np.subtract.outer(places := np.cumsum(steps) - steps, places))
    far = np.minimum(along, steps.sum() - along) > 1.1 * np.pi * radius
    return pdist(points)[squareform(far, checks=False)].min() / (2.0 * radius)


@pytest.fixture(scope="module")
def rope():
    iterates = []
    minimize(knot("4_1"), RelaxOptions(radius="keep"), iterates.append)
    return iterates


@pytest.mark.parametrize(
    ("measure", "timing"), [(Measure.LENGTH, None), (Measure.RADIUS, Timing(length=120))], ids=["few", "smooth"]
)
def test_a_rope_is_drawn_as_it_is_and_has_room_from_key_to_key(measure, timing, rope):
    """Also where the mesh changes on the way, so that keys have points on edges."""
    motion, _ = recorded(rope, measure)
    keys = motion.keys(is_rope, None if timing else 40, timing)
    assert keys.certified
    assert bool(timing) == (keys.kinds[Kind.ADDED] > 20)
    radii = rope_radii(motion.start.mesh, keys)
    lengths = [Curve(key.points.astype(float), motion.start.mesh).length for key in keys.keys]
    expected = 0.998 * rope[-1].radius[0] * np.array(lengths) / rope[0].curve.length
    np.testing.assert_allclose(radii, np.outer(expected, np.ones(motion.start.mesh.size)), rtol=0.01)
    for (a, one), (b, other) in pairwise(zip(keys.keys, radii[:, 0], strict=True)):
        for t in (0.0, 0.5):
            assert crowding((1.0 - t) * a.points + t * b.points.astype(float), (1.0 - t) * one + t * other) >= 1.0
    still = motion.result(is_rope)
    assert still.certified
    assert still.keys[0].radius == radii[-1, 0]


def test_what_is_not_proved_as_a_rope_is_free_of_contact_and_has_no_radius():
    """Smooth pieces stay straight where they fail as ropes alone, and keys have no radius if a chord does."""
    ring = regular_polygon(30)
    shapes = [ring.with_vertices(ring.vertices + np.array([0.5 * k, 0.5 * (k % 2), 0.0])) for k in range(9)]
    motion = followed(iterate(k, each.vertices, each, radius=(0.1,)) for k, each in enumerate(shapes))
    timing, iterates = Timing(pace=Pace.ITERATE, frames_per_iterate=12.0), {s.vertices[0, 0] for s in shapes}
    for straight, chords in ((True, True), (True, False), (False, True)):

        def proved(_mesh, start, end, radius=None, straight=straight, chords=chords):
            known = {start[0, 0], end[0, 0]} <= {np.float64(np.float32(x)) for x in iterates}
            return radius is None or (straight if known else chords)

        keys = motion.keys(proved, None, timing)
        assert keys.certified
        assert len(keys.keys) == (9 if straight and not chords else 97)
        assert {key.radius for key in keys.keys} == {0.998 * 0.1 if straight else 0.0}
    assert motion.result(lambda *given: len(given) == 3).keys[0].radius == 0.0


def test_between_two_sizes_a_rope_is_proved_in_one():
    """A ring that becomes twice as large is shown in one size, with half the radius at the end."""
    shapes, seen = [Curve(factor * RING) for factor in (1.0, 2.0)], []

    def proved(_mesh, start, end, radius=None):
        seen.extend([] if radius is None else [(radius[0], np.ptp(end, axis=0)[0] / np.ptp(start, axis=0)[0])])
        return True

    made = (iterate(k, each.vertices, each, radius=(0.1,)) for k, each in enumerate(shapes))
    keys = followed(made, measure=Measure.RADIUS, in_points=True).keys(proved)
    np.testing.assert_allclose(seen, [(0.0999, 1.0), (0.0999, 2.0)], rtol=1e-6)
    assert [key.radius for key in keys.keys] == pytest.approx([0.0998, 0.0499])


def test_points_that_are_no_corners_are_left_out_but_not_a_whole_arc_of_them():
    """On a circle so fine that each point is on an edge, up to 32-bit rounding, the arc is still there."""
    n = 20_000
    angles = 2.0 * np.pi * np.arange(n) / n
    circle = np.stack([np.cos(angles), np.sin(angles), 0.0 * angles], axis=1)
    mesh, start, end = corners(Mesh((n,)), circle, 2.0 * circle, 0.1)
    assert mesh.size == pytest.approx(n / 8, rel=0.1)
    np.testing.assert_array_equal(2.0 * start, end)
    assert np.linalg.norm(Curve(start).midpoints, axis=1).min() > 1.0 - 1e-6


def test_a_rope_with_long_ends_is_drawn_as_it_is():
    """It is thin for its length, but not for what is seen of it."""
    tied = knot("bowline", 100).vertices
    out = tied[[0, -1]] - tied[[1, -2]]
    points = np.concatenate([tied[:1] + 300.0 * out[:1], tied, tied[-1:] + 300.0 * out[1:]]).astype(np.float32)
    radii = rope_radii(Mesh((102,), (False,)), Keys((Key(0.0, points, radius=0.2),), 0))
    np.testing.assert_array_equal(radii, np.full((1, 102), 0.2))
