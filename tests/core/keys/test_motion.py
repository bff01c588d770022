"""Which frames are keyed: straight lines from key to key are proved, in Blender's own numbers."""

from itertools import pairwise

import numpy as np
import pytest
from mobius_flow.core import Curve
from mobius_flow.core.collision import is_free, is_rope
from mobius_flow.core.io.trajectory import StrandMoves
from mobius_flow.core.keys.key_options import Pace, Timing
from mobius_flow.core.keys.motion import Recording
from mobius_flow.core.keys.placement import Link, Placement
from mobius_flow.core.keys.recording import Kind
from recorded_motions import around, assert_proved, at_rest, collected, followed, iterate
from shapes import regular_polygon, torus_trefoil


@pytest.mark.parametrize(("angle", "most"), [(0.4, 2), (np.pi, 5)], ids=["free", "colliding"])
def test_a_chord_that_collides_gets_keys_at_the_legs(angle, most):
    start, end = around(0.0), around(angle)
    legs = tuple(around(each).vertices for each in np.linspace(0, angle, 5)[1:])
    assert is_free(start.mesh, start.vertices, end.vertices) == (most == 2)
    keys = collected([start, end], {1: legs}).keys(is_rope)
    assert 2 <= len(keys.keys) <= most
    assert_proved(keys, start.mesh)
    assert {key.points.tobytes() for key in keys.keys[1:]} <= {leg.astype(np.float32).tobytes() for leg in legs}


def test_what_cannot_be_proved_is_counted_not_hidden():
    keys = collected([around(0.0), around(np.pi)]).keys(is_rope)
    assert (keys.certified, keys.unproved, len(keys.keys)) == (False, 1, 2)
    square = regular_polygon(4).vertices + 1000.0
    close = Curve.from_components([square, square + np.array([1.0, 0.0, 1e-12])])
    assert not collected([close, close]).keys(is_rope).certified
    assert not collected([close]).result(is_rope).certified
    curve = around(0.0)
    made = (iterate(k, curve.vertices, curve, certified=k == 0) for k in (0, 1))
    assert not followed(made, at_rest(2)).result(is_rope).certified


@pytest.mark.parametrize(
    ("heights", "longest", "times"),
    [((1.0, 4.0, 5.0), 3.5, [0, 0.2, 0.8, 1]), ((1.0,), 0.3, [0, 0.25, 0.5, 0.75, 1])],
    ids=["of legs follow their lengths", "of one unproved leg that is halved"],
)
def test_times(heights, longest, times):
    start = regular_polygon(4)
    path = tuple(start.vertices + np.array([0, 0, z]) for z in heights)
    motion = collected([start, start.with_vertices(path[-1])], {1: path})
    keys = motion.keys(lambda _mesh, a, b: np.abs(b - a).max() < longest)
    assert [key.time for key in keys.keys] == pytest.approx(times)
    assert keys.certified


@pytest.mark.parametrize("limit", [2, 5, 9])
def test_thinning_spreads_keys_and_inserts_iterates_where_chords_collide(limit):
    curves = [around(angle) for angle in np.linspace(0, np.pi, 21)]
    keys = collected(curves).keys(is_rope, limit=limit)
    assert limit <= len(keys.keys) < 10
    assert_proved(keys, curves[0].mesh)
    assert {key.time for key in keys.keys} <= set(range(21))
    curves = [around(angle) for angle in np.linspace(0, 0.5, 21)]
    keys = collected(curves).keys(is_rope, limit=limit)
    assert len(keys.keys) == limit
    np.testing.assert_allclose([key.time for key in keys.keys], np.linspace(0, 20, limit), atol=0.5 + 1e-9)
    assert_proved(keys, curves[0].mesh)


@pytest.mark.parametrize("still", [(0.0, 1.0), (1.0, 1.0), (0.0, 0.0)])
def test_legs_too_short_for_32_bits_have_times_of_their_own(still):
    start = regular_polygon(4)
    path = tuple(start.vertices + np.array([0, 0, z]) for z in still)
    motion = collected([start, start.with_vertices(path[-1])], {1: path})
    times = [key.time for key in motion.keys(lambda *_: False).keys]
    assert len(times) == 3
    assert (times[0], times[-1]) == (0, 1)
    assert (np.diff(times) > 0).all()


def test_rounding_of_the_start_is_a_gap_of_its_own():
    curve = regular_polygon(4).with_vertices(0.1 * regular_polygon(4).vertices)
    motion = collected([curve, curve.with_vertices(2.0 * curve.vertices)])
    keys = motion.keys(lambda _mesh, a, _b: np.array_equal(a, a.astype(np.float32)))
    assert keys.unproved == 1


def test_thinning_keys_iterates_rather_than_the_ends_of_legs():
    angles = np.linspace(0, np.pi, 8)  # an odd number of steps, so that the middle of all legs is within one
    curves = [around(angle) for angle in angles]
    halves = {k + 1: (around(0.5 * (a + b)).vertices, around(b).vertices) for k, (a, b) in enumerate(pairwise(angles))}
    times = [key.time for key in collected(curves, halves).keys(is_rope, limit=2).keys]
    assert len(times) > 2
    assert times == [round(time) for time in times]


@pytest.mark.parametrize("limit", [1, 2, 3])
def test_thinned_keys_begin_at_the_start_and_end_at_the_end(limit):
    start = regular_polygon(4)
    curves = [start.with_vertices(start.vertices + np.array([0, 0, z])) for z in (0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0)]
    times = [key.time for key in collected(curves).keys(lambda *_: True, limit).keys]
    assert (times[0], times[-1]) == (0, 6)


def placed(linear, origin):
    return Placement(np.array(linear, dtype=float), np.array(origin, dtype=float))


TURNED = placed([[0, -2, 0], [0.5, 0, 0.1], [0, 0, -3]], [100, -7, 3])


@pytest.mark.parametrize("placements", [(TURNED, placed(np.eye(3), [1, 2, 3])), (placed(np.eye(3), 3 * [0]), TURNED)])
def test_chords_of_different_objects_are_proved_against_each_other(placements):
    """Each square by itself may go straight; together the second must go round the first."""
    link = Link(placements, (1, 1))
    curves = [around(angle) for angle in np.linspace(0, np.pi, 21)]
    keys = collected(curves, link=link).keys(is_rope, limit=2)
    mesh = curves[0].mesh
    assert keys.certified
    assert 2 < len(keys.keys) < 10
    for a, b in pairwise(keys.keys):
        world = [
            np.concatenate([placements[k].to_world(key.points[mesh.slices[k]].astype(np.float64)) for k in (0, 1)])
            for key in (a, b)
        ]
        assert is_free(mesh, *world)
    for k, s in enumerate(mesh.slices):
        alone = collected([Curve(curve.vertices[s]) for curve in curves], link=Link((placements[k],), (1,)))
        assert len(alone.keys(is_rope, limit=2).keys) == 2


ZIGZAG = Timing(pace=Pace.ITERATE, frames_per_iterate=12.0)


@pytest.fixture
def zigzag():
    ring = regular_polygon(30)
    shifts = [np.array([0.5 * k, 0.5 * (k % 2), 0.0]) for k in range(9)]
    return collected([ring.with_vertices(ring.vertices + shift) for shift in shifts])


@pytest.mark.parametrize("limit", [None, 65])
def test_keys_on_curves_through_the_iterates_make_a_motion_smooth(zigzag, limit):
    sharp, smooth = zigzag.keys(is_rope, limit), zigzag.keys(is_rope, limit, ZIGZAG)
    assert_proved(smooth, zigzag.start.mesh)
    assert len(smooth.keys) == pytest.approx(limit or 8 * 12 + 1, abs=9)
    assert smooth.kinds[Kind.STEP] == 9
    iterates = [key for key in smooth.keys if key.kind is Kind.STEP]
    for one, other in zip(iterates, sharp.keys, strict=True):
        assert one.time == other.time
        np.testing.assert_array_equal(one.points, other.points)
    corners = []  # angles by which the way turns at keys, in space and time
    for keys in (sharp, smooth):
        pairs = zip(keys.keys, ZIGZAG.frames(zigzag.course(keys)), strict=True)
        ways = np.diff([np.append(key.points.astype(float).ravel(), frame) for key, frame in pairs], axis=0)
        ways /= np.linalg.norm(ways, axis=1)[:, None]
        corners.append(np.arccos(np.clip((ways[1:] * ways[:-1]).sum(axis=1), -1.0, 1.0)).max())
    assert corners[1] < 0.5 * corners[0]


def test_at_most_half_of_many_keys_are_added_and_no_more_than_there_are_times_for():
    ring = regular_polygon(20)
    motion = collected([ring.with_vertices(ring.vertices + 0.1 * np.sin(k)) for k in range(100)])
    keys = motion.keys(is_rope, None, Timing(length=2000))
    assert 0.5 * len(keys.keys) <= keys.kinds[Kind.STEP] == 100 < 0.6 * len(keys.keys)
    timing = Timing(length=2)
    keys = motion.keys(is_rope, None, timing)
    assert 20 < len(keys.keys) < 70
    assert np.diff(timing.frames(motion.course(keys))).min() > 0.01


def test_where_a_smooth_motion_is_not_proved_it_stays_straight(zigzag):
    iterates = {key.points.tobytes() for key in zigzag.keys(is_rope).keys}

    def free(_mesh, start, end):
        near = min(start[0, 0], end[0, 0]) < 2.0
        return near or {start.astype(np.float32).tobytes(), end.astype(np.float32).tobytes()} <= iterates

    keys = zigzag.keys(free, None, ZIGZAG)
    assert keys.certified
    late = [key for key in keys.keys if key.time >= 4]
    assert {key.kind for key in late} == {Kind.STEP}
    assert keys.kinds[Kind.ADDED] > 20


def test_strand_moves_are_seen_by_flow_time_as_long_as_by_distance():
    ring = regular_polygon(8)
    moves = StrandMoves(2, 0)
    shapes = [ring.with_vertices(ring.vertices + np.array([0.3 * k, 0.0, 0.0])) for k in range(9)]
    made = [
        iterate(k, each.vertices, ring, strand_moves=None if k == 0 else moves._replace(done=k > 4))
        for k, each in enumerate(shapes)
    ]
    motion = followed(made)
    keys = motion.keys(is_rope)
    assert [key.kind for key in keys.keys] == [Kind.STEP] + 4 * [Kind.MOVE] + 4 * [Kind.STEP]
    timing = Timing(pace=Pace.FLOW_TIME, length=101)
    np.testing.assert_allclose(timing.frames(motion.course(keys)), np.linspace(1, 101, 9), atol=0.02)


def test_pinned_points_keep_the_numbers_of_the_start_and_points_at_rest_stay_exactly_where_they_are():
    """However they are rounded: here by turns to either side of what lies halfway between two 32-bit numbers."""
    curve = torus_trefoil(40)
    step = np.spacing(np.float32(1.0)).astype(np.float64)
    motion = Recording(at_rest(1))
    for k in range(9):
        vertices = curve.vertices + np.where(np.arange(40) < 15, 0.0, 0.1 * (k % 2))[:, None]
        vertices[7] = 1.0 + 0.5 * step + (-1) ** k * 1e-12
        motion.add(iterate(k, vertices, curve, pins=(7,)))
    for timing in (None, ZIGZAG):
        frames = [key.points for key in motion.keys(lambda *_: True, None, timing).keys]
        assert len({frame[:15].tobytes() for frame in frames}) == 1
        assert len({frame.tobytes() for frame in frames}) > 1


@pytest.mark.parametrize("energies", [(90.0, 40.0, 7.0, 4.0, 4.0, 7.0, 40.0, 90.0), (90.0, 40.0, 4.0, 5.0, 4.5)])
def test_falls_of_the_energy_count_and_rises_on_the_way_to_another_curve_but_not_on_a_finer_mesh(energies):
    start = regular_polygon(5)
    motion = followed(iterate(k, start.vertices + 0.1 * k, start, energy=energy) for k, energy in enumerate(energies))
    fall = motion.course(motion.keys(is_rope)).fall
    if energies[-1] > 5.0:
        np.testing.assert_allclose(np.diff(fall), np.diff(fall)[::-1], atol=1e-12)
        assert fall[3] > 5.0
    else:
        assert fall[2] == fall[-1] > 5.0
