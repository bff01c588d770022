"""When keys are shown: even motion is even, frames are distinct in 32 bits, and what has no room is refused."""

import numpy as np
import pytest
from families import family
from mobius_flow.core import OptionError, RelaxOptions, relax
from mobius_flow.core.collision import is_rope
from mobius_flow.core.keys.key_options import LAST_FRAME, Course, Pace, Timing
from mobius_flow.core.keys.motion import Recording
from mobius_flow.core.keys.placement import Link, Placement
from mobius_flow.core.knots import knot

LENGTHS = [pace for pace in Pace if pace is not Pace.ITERATE]


@pytest.fixture(scope="module", params=family(["5_2", "6_1", "7_4"]))
def motion(request):
    """A relaxation whose iterates move much at first and hardly at last."""
    motion = Recording(Link((Placement(np.eye(3), np.zeros(3)),), (1,)))
    for iterate in relax(knot(request.param, 100), RelaxOptions(mesh="fixed", vertices=100)):
        motion.add(iterate)
    return motion


def half_way(keys, frames):
    """The share of the frames in which half of the vertices' way is travelled, as it is seen frame by frame."""
    points = np.array([key.points for key in keys.keys], dtype=np.float64)
    seen = np.arange(np.ceil(frames[0]), np.floor(frames[-1]) + 1)
    places = np.interp(seen, frames, np.arange(len(frames)))
    below = np.minimum(places.astype(int), len(points) - 2)
    part = (places - below)[:, None, None]
    shown = (1 - part) * points[below] + part * points[below + 1]
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(shown, axis=0), axis=2).mean(axis=1))])
    return np.interp(0.5, way / way[-1], np.linspace(0, 1, len(way)))


@pytest.mark.parametrize("limit", [None, 60])
@pytest.mark.parametrize("pace", [Pace.EVEN, Pace.DISTANCE])
def test_half_of_the_motion_is_travelled_in_the_middle_of_the_frames(motion, pace, limit):
    keys = motion.keys(is_rope, limit, Timing(pace=pace))
    assert keys.certified
    frames = Timing(pace=pace).frames(motion.course(keys))
    assert (frames[0], frames[-1]) == (1, 250)
    assert 1 / 3 < half_way(keys, frames) < 2 / 3
    # what even timing is for: by iterate it is not so, and the test notices if nothing is made even
    every = motion.keys(lambda *_: True)
    assert half_way(every, Timing(pace=Pace.ITERATE).frames(motion.course(every))) < 1 / 4


def test_thinned_keys_are_passed_when_they_are_without_thinning_and_spread_over_the_frames(motion):
    """Where an iterate takes no longer than that, keys of an even motion are about evenly far apart."""
    timing = Timing(pace=Pace.DISTANCE)
    every, few = motion.keys(lambda *_: True), motion.keys(lambda *_: True, 20)
    times = [key.time for key in every.keys]
    frames = dict(zip(times, timing.frames(motion.course(every)), strict=True))
    assert len(few.keys) <= 20
    for key, frame in zip(few.keys, timing.frames(motion.course(few)), strict=True):
        assert frame == pytest.approx(frames[key.time], abs=1e-3)
    passed = motion.course(motion.keys(lambda *_: True, 12)).evenly
    assert np.diff(passed).max() < 1 / 11 + np.diff(motion._course.evenly).max()


def course(distance, flow_time=None):
    """One without drift."""
    distance = np.array(distance, dtype=float)
    flow_time = distance if flow_time is None else np.array(flow_time, dtype=float)
    return Course(np.arange(len(distance), dtype=float), distance, flow_time, 1e4 * distance, 0.0 * distance)


def test_what_passes_evenly():
    """An even motion sets off and comes to rest gently: full speed in between, a fifth of it or less at both ends."""
    given = course([0, 3, 4], [0, 1, 10])
    for pace, shares in ((Pace.ITERATE, [0, 0.5, 1]), (Pace.DISTANCE, [0, 0.75, 1]), (Pace.FLOW_TIME, [0, 0.1, 1])):
        assert given.share(pace) == pytest.approx(shares)
    share = course(np.linspace(0, 1, 1001)).share(Pace.EVEN)
    speed = 1e-3 / np.diff(share)
    assert share[500] == pytest.approx(0.5, abs=1e-3)
    assert max(speed[0], speed[-1]) < 0.2 * speed[500]
    assert np.diff(speed[100:900]) == pytest.approx(0, abs=1e-6)
    # drift without a fall of the energy takes fewer frames
    distance = np.arange(11.0)
    falls = (distance, np.minimum(distance, 2.0))
    plain, drifting = (Course(distance, distance, distance, fall, 0.0 * distance).share(Pace.EVEN) for fall in falls)
    assert drifting[2] > 1.3 * plain[2]
    assert (np.diff(drifting) > 0).all()


def test_nothing_jumps():
    """In no frame more than two and a half times the median, though the energy hardly falls on most of the way."""
    distance = np.concatenate([np.linspace(0.0, 1.0, 100), np.linspace(1.1, 5.0, 20)])
    jumping = Course(np.arange(120.0), distance, distance, np.minimum(distance, 1.0), 0.0 * distance)
    moved = np.diff(np.interp(np.linspace(0.0, 1.0, 200), jumping.share(Pace.EVEN), distance))
    assert moved.max() < 2.5 * np.median(moved)


def test_nothing_crawls():
    """Though all of the energy falls in one step, which leads no further than others."""
    distance = np.arange(101.0)
    falling = Course(distance, distance, distance, 1e4 * (distance > 50.0), 0.0 * distance)
    assert np.diff(falling.share(Pace.EVEN))[50] < 0.06


ITERATE = Pace.ITERATE
RESTS = {"start_frame": 11, "length": 100, "hold_start": 5, "hold_end": 8}
FRAMES = [  # of a timing the first and the last frame of the motion, and of the scene
    *(({"pace": pace} | RESTS, (16, 102), (11, 110)) for pace in LENGTHS),
    (RESTS | {"pace": ITERATE, "frames_per_iterate": 2.5}, (16, 23.5), (11, 32)),
    (RESTS | {"loop": True}, (16, 53), (11, 110)),
    ({"length": 100, "loop": True}, (1, 51), (1, 100)),
    ({}, (1, 250), (1, 250)),
]


@pytest.mark.parametrize(("values", "motion", "scene"), FRAMES)
def test_lengths_rests_and_ways_back(values, motion, scene):
    timing = Timing(**values)
    frames = timing.frames(course([0, 1, 2, 10]))
    assert (frames[0], frames[-1]) == motion
    assert timing.scene_range(frames) == scene
    back = timing.way_back(frames)
    assert len(back) == (0 if not timing.loop else 4 if timing.hold_end else 3)
    np.testing.assert_allclose(back, (2 * (motion[1] + timing.hold_end) - frames[::-1])[4 - len(back) :])


def test_a_way_that_is_hardly_one_is_short():
    timing = Timing(length=200, hold_end=10)
    assert [timing.shortened(way).length for way in (1.0, 0.0, 0.05)] == [200, 12, 62]
    assert Timing(pace=Pace.ITERATE).shortened(0.0).length == 250


@pytest.mark.parametrize("pace", Pace)
def test_a_curve_that_rests_is_passed_by_iterate(pace):
    frames = Timing(pace=pace, length=3).frames(course([0, 0, 0]))
    np.testing.assert_array_equal(frames, [1, 2, 3])
    np.testing.assert_array_equal(Timing(pace=pace).frames(course([0])), [1])


@pytest.mark.parametrize("start", [-LAST_FRAME, 0, 16_777, LAST_FRAME - 249])
@pytest.mark.parametrize("pace", Pace)
def test_keys_stay_apart_in_blenders_numbers(start, pace):
    """Keys of short ways lie nearer together than 32 bits tell frames apart; none may fall on another."""
    times = np.concatenate([k + np.array([0, 1e-7, 2e-7, 0.5, 0.5 + 1e-9]) for k in range(50)])
    distance = np.minimum(times, 20.0)  # all is crowded at the end
    frames = Timing(pace=pace, start_frame=start).frames(Course(times, distance, distance, distance, 0.0 * distance))
    assert (np.diff(frames.astype(np.float32)) > 0).all()
    last = start + times[-1] if pace is Pace.ITERATE else start + 249
    assert abs(frames[-1] - last) < 0.1
    assert frames[-1] <= LAST_FRAME


def test_keys_that_all_fall_on_one_frame_begin_there():
    times = np.array([0.0, 0.1, 0.2])
    timing = Timing(pace=Pace.ITERATE, start_frame=1_000_000, frames_per_iterate=0.1)
    frames = timing.frames(Course(times, times, times, times, 0.0 * times))
    assert frames[0] == 1_000_000
    assert (np.diff(frames.astype(np.float32)) > 0).all()


LATE = {"start_frame": LAST_FRAME - 250}
REFUSED = [
    ({"length": 20, "hold_start": 10, "hold_end": 10}, "Length is 20 frames, which leaves none to move in"),
    ({"length": 1}, "it must be at least 2"),
    ({"length": 23, "hold_end": 11, "loop": True}, "it must be at least 24"),
    ({"hold_end": -1}, "Hold at Start and Hold at End must be 0 frames or more"),
    ({"start_frame": float("nan")}, "Start Frame is nan"),
    ({"frames_per_iterate": 0.0}, "Frames/Iterate is 0; it must be from 0.1 to 10000"),
    (LATE | {"pace": ITERATE}, "The animation would go on to frame 1049324, but .*Frames/Iterate or Max Iter"),
    (LATE | {"length": 1000}, "The animation would go on to frame 1049323, .*a smaller Start Frame or Length"),
    (LATE | {"length": 252, "hold_end": 9}, "would go on to frame 1048575, but Blender's last is 1048574"),
]


@pytest.mark.parametrize(("values", "said"), REFUSED)
def test_what_is_out_of_range_is_refused(values, said):
    with pytest.raises(OptionError, match=said):
        Timing(**values).check_room(1000)
