"""Contacts of edges between two frames: each is found, once, with its time, way and place, and touches are told so."""

import numpy as np
import pytest
from mobius_flow.core import CurveError
from mobius_flow.core.proof.passings import Placed, passings

NO_BOX = np.zeros((3, 3))
LYING = np.array([[-1.0, 0, 0], [1, 0, 0]])


def of_two(start, end, cell=NO_BOX, *, from_start=True):
    """Contacts of two open edges, whose four ends are rows."""
    frames = (Placed(np.array(each, dtype=float), np.zeros((4, 3), dtype=int), cell) for each in (start, end))
    return passings(*frames, np.arange(4), np.array([0, 2]), from_start)


def bar(x, height, tilt=0.0):
    """An edge across the lying one."""
    return np.array([[x, -1.0, height - tilt], [x, 1.0, height + tilt]])


def test_a_bar_falls_through_another():
    (found,) = of_two([*LYING, *bar(0.25, 1.0)], [*LYING, *bar(0.25, -3.0)])
    assert found["time"] == 0.25
    assert found["place"].tolist() == [0.25, 0.0, 0.0]
    (back,) = of_two([*LYING, *bar(0.25, -3.0)], [*LYING, *bar(0.25, 1.0)])
    assert found["sign"] == -back["sign"] != 0


def test_edges_that_pass_several_times_are_told_each_time():
    # the bar turns over while the lying edge shifts: the volume is a cubic with three roots in between
    rng = np.random.default_rng(2)
    most = 0
    for _ in range(300):
        start, end = rng.normal(size=(2, 4, 3))
        found = of_two(start, end)
        most = max(most, len(found))
        assert (np.diff(found["time"]) > 0).all()
        for each in found:  # both edges have the place, at that time
            x0, x1, y0, y1 = (1 - each["time"]) * start + each["time"] * end
            for a, b in ((x0, x1), (y0, y1)):
                along = np.clip((each["place"] - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
                assert np.allclose(a + along * (b - a), each["place"], atol=1e-9)
    assert most >= 2


@pytest.mark.parametrize(
    ("start", "end", "time"),
    [
        pytest.param(bar(1.0, 1.0), bar(1.0, -1.0), 0.5, id="through an end"),
        pytest.param(bar(0.0, 1.0), bar(0.0, 0.0), 1.0, id="at the end"),
        pytest.param(bar(0.0, 0.0), bar(0.0, 1.0), 0.0, id="from the start"),
        pytest.param([[2.0, 0, 0], [3, 0, 0]], [[0, 0, 0], [3, 0, 0]], 0.5, id="along one line"),
        pytest.param(bar(2.0, 0.0), bar(0.0, 0.0), 0.5, id="in one plane"),
        pytest.param([[0.0, -1, 1], [0, 1, 1]], [[0, -1, -1], [0, -1, -1]], 0.5, id="shrinking to a point"),
        pytest.param([[0.0, 0, -0.25], [0, 1, 0.25]], [[0, -1, 0.25], [0, 0, -0.25]], 0.5, id="and turns back"),
    ],
)
def test_what_only_touches_is_told_once_and_so(start, end, time):
    (found,) = of_two([*LYING, *start], [*LYING, *end])
    assert (found["sign"], found["time"]) == (0, pytest.approx(time, abs=1e-15))
    before = of_two([*LYING, *start], [*LYING, *end], from_start=False)
    assert len(before) == (time > 0)


def test_neighbours_do_not_count_and_all_others_do():
    # a closed quadrilateral that turns inside out, whose opposite edges pass through each other
    beads = np.array([0, 1, 2, 3, 0])
    start = np.array([[0.0, 0, 0], [1, 0, 0.5], [1, 1, 0], [0, 1, 0.5]])
    end = start * [1.0, 1.0, -1.0] + [[0, 0, 0], [0, 1, 0], [0, 0, 0], [0, -1, 0]]
    frames = [Placed(each[beads], np.zeros((5, 3), dtype=int), NO_BOX) for each in (start, end)]
    found = passings(*frames, beads, np.arange(4))
    assert {tuple(each) for each in found["edges"].tolist()} <= {(0, 2), (1, 3)}
    assert len(found)


@pytest.mark.parametrize("cell", [np.diag([4.0, 5.0, 6.0]), np.array([[4.0, 0, 0], [1.5, 5, 0], [-1, 2, 6]])])
def test_images_meet_wherever_the_file_has_them(cell):
    """The same motion, with each end of each edge moved by whole boxes in the file, also between the frames."""
    rng = np.random.default_rng(7)
    start = np.array([*LYING, *bar(0.25, 1.0, 0.1)])
    end = np.array([*LYING, *bar(0.25, -3.0, 0.1)])
    (known,) = of_two(start, end)
    for _ in range(20):
        lattice, shift = rng.integers(-3, 4, size=(2, 4, 3)), rng.integers(-3, 4, size=3)
        frames = []
        for points, boxes in zip((start, end), lattice, strict=True):
            whole = np.array([[0, 0, 0], [0, 0, 0], shift, shift])
            frames.append(Placed(points + (whole - boxes) @ cell, boxes, cell))
        (found,) = passings(*frames, np.arange(4), np.array([0, 2]))
        assert found["image"].tolist() == (-shift).tolist()
        assert found["sign"] == known["sign"]
        assert found["time"] == pytest.approx(known["time"], abs=1e-12)
        assert np.allclose(found["place"], known["place"] - lattice[0, 0] @ cell)


def test_a_growing_box_carries_images_along():
    """An image recedes with the box: what would meet in the first one's does not."""
    frames = [np.array([*LYING, *bar(0.0, height)]) for height in (5.0, 4.0)]
    places = [Placed(each, np.zeros((4, 3), dtype=int), np.diag([9.0, 9.0, 4.5])) for each in frames]
    (found,) = passings(*places, np.arange(4), np.array([0, 2]))
    assert (found["image"].tolist(), found["time"]) == ([0, 0, -1], 0.5)
    places[1] = Placed(frames[1], places[1].lattice, np.diag([9.0, 9.0, 3.9]))
    assert len(passings(*places, np.arange(4), np.array([0, 2]))) == 0


def test_a_box_that_is_too_small_is_refused():
    with pytest.raises(CurveError, match="further than through a whole one"):
        of_two([*LYING, *bar(0.0, 1.0)], [*LYING, *bar(0.0, -9.0)], np.diag([9.0, 9.0, 2.0]))
