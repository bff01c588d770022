"""Whole curves are untangled by proved motions: knots, links, arcs, among pins and obstacles, and interrupted."""

import numpy as np
import pytest
from families import family
from mobius_flow.core import Curve, Iterate, Task
from mobius_flow.core.base.deadline import TimeIsUp, TimeLimit
from mobius_flow.core.knots import knot, knot_type, scramble
from mobius_flow.core.untangle import Legs, untangled, worth
from solids import plate
from tasks import check


def check_stages(start, stages, pins=(), walls=()):
    """Have the independent check accept stages."""
    frames = [(start, ()), *((each, path) for s in stages for each, path in ((s.start, ()), (s.end, s.path)))]
    iterates: list[Iterate] = []
    for curve, path in ((curve, path) for k, (curve, path) in enumerate(frames) if path or k % 2 or not k):
        places = [int(np.flatnonzero((curve.vertices == start.vertices[pin]).all(axis=1))[0]) for pin in pins]
        iterates.append(Iterate(len(iterates), curve, 0.0, 0.0, 0.0, path, True, 0.0, "moves", pins=tuple(places)))
    check(iterates, Task(curve=start, obstacles=tuple(walls)))


def run(curve, pins=(), walls=()):
    """Where it ends and how, if the independent check accepts the way."""
    stages: list[Legs] = []
    found = ended(untangled(curve, np.array(pins, dtype=np.intp), walls), stages)
    check_stages(curve, stages, pins, walls)
    return stages[-1].end, found


def ended(work, stages):
    """How it ends."""
    while True:
        try:
            stages.append(next(work))
        except StopIteration as end:
            return end.value


@pytest.mark.parametrize("name", family(["culprit", "goeritz", "thistlethwaite", "ochiai-1", "d28"], 3))
def test_famous_unknots_lose_all_crossings(name):
    end, found = run(knot(name))
    assert found == "no crossing is left"
    assert end.length == pytest.approx(knot(name).length)


@pytest.mark.parametrize("case", family([("5_2", 5), ("m7_4", 7), ("L6a4", 6), ("3_1#m4_1", 7), ("3_1#3_1", 6)], 2))
def test_scrambled_knots_and_links_come_to_their_crossings(case):
    name, crossings = case
    curve = scramble(knot(name, 60), 1, moves=400)
    end, found = run(curve)
    assert found == f"{crossings} crossings are left, as few as can be"
    assert str(knot_type(end)) == str(knot_type(curve))
    assert len(end.mesh.component_sizes) == len(curve.mesh.component_sizes)


def test_a_knot_of_which_no_least_diagram_is_known_says_so():
    _, found = run(scramble(knot("8_19", 60), 1, moves=300))
    assert found.startswith("8 crossings are left, as no free way of a strand is known")


def test_pins_stay_and_strands_end_at_them():
    curve, pins = scramble(knot("5_2", 60), 1, moves=400), [0, 20, 40]
    end, found = run(curve, pins)
    assert found.startswith("5 crossings are left")
    places = set(map(tuple, end.vertices.tolist()))
    assert all(tuple(point) in places for point in curve.vertices[pins].tolist())


@pytest.mark.parametrize(("part", "free"), [(0.5, True), (0.01, False)])
def test_plates_leave_room_or_none(part, free):
    curve = knot("ochiai-1")
    low, high = curve.vertices[:, 2].min(), curve.vertices[:, 2].max()
    gap = part * np.ptp(curve.vertices, axis=0).max()
    _, found = run(curve, walls=[plate(low - gap, name="below"), plate(high + gap, name="above")])
    assert (found == "no crossing is left") is free
    assert free or "crossings are left, as no" in found  # free way, or no view shows what is in front


def test_what_cannot_be_untangled_is_left_alone():
    assert list(untangled(Curve(np.random.default_rng(1).normal(size=(9, 4))))) == []
    gone, left = worth(knot("5_2", 100))
    assert gone < left == 5
    gone, left = worth(knot("ochiai-2"), 20)
    assert gone > 20 > left


turn = 2.0 * np.pi * np.arange(6000) / 6000
TWICE = 2.0 * turn[::15]  # a trefoil, run through twice
TREFOIL = np.stack(
    [np.sin(TWICE) + 2.0 * np.sin(2.0 * TWICE), np.cos(TWICE) - 2.0 * np.cos(2.0 * TWICE), -np.sin(3.0 * TWICE)], axis=1
)
ASIDE = np.cos(0.5 * np.outer(TWICE, [1, 3, 5]))
rng = np.random.default_rng(1)
WAVES = sum(rng.normal(size=(3, 1)) * np.cos(k * turn + rng.uniform(0.0, 6.0, size=(3, 1))) for k in range(60, 130))


@pytest.mark.parametrize(
    ("vertices", "said"),
    [*((TREFOIL + gap * ASIDE, "strands touch, or near") for gap in (1e-9, 1e-13, 1e-15)), (WAVES.T, "5,000 cross")],
)
def test_strands_too_near_to_tell_and_too_many_crossings_are_left_alone(vertices, said):
    curve, stages = Curve(vertices), []
    assert said in ended(untangled(curve), stages)
    assert not stages
    assert worth(curve) == (0, 0)


def test_a_time_limit_ends_the_search_for_views():
    limit = TimeLimit(1e-9)
    with pytest.raises(TimeIsUp), limit:
        worth(knot("3_1", 40))
