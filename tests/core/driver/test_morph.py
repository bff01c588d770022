"""A morph begins at one curve and ends at the other, bit for bit, and the independent verifier accepts all of it."""

import sys
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from families import family
from mobius_flow.core import (
    Curve,
    CurveError,
    Mesh,
    NoMotionError,
    Obstacle,
    OptionError,
    RelaxOptions,
    Status,
    Task,
    minimize,
    morph,
    relax,
)
from mobius_flow.core.driver.meeting import meeting, prove_legs, run_back
from mobius_flow.core.knots import knot, overhand, smooth_knot
from tasks import check

QUICK = RelaxOptions(tolerance=1e-3, mesh="fixed", untangle="never")
COARSE = replace(QUICK, vertices=60)
SQUARE = [[0.0, 0], [1, 0], [1, 1], [0, 1]]
LARGER = Curve(3.0 + 1.1 * np.array(SQUARE))
RECTANGLE = [[0.0, 0, 0], [3, 0, 0], [3, 1, 0], [0, 1, 0]]
ZIGZAG = [[9.0, 9, 9], [10, 9, 9.5], [11, 9, 9], [11, 11, 8.5], [10, 10, 8], [9, 11, 9]]
FAR = np.array([50.0, -20.0, 7.0])


def moved(curve, scale=3.0):
    """A curve elsewhere, turned over and of another size."""
    turn = np.array([[0.0, 0.6, 0.8], [1.0, 0.0, 0.0], [0.0, 0.8, -0.6]])
    return curve.with_vertices(FAR + scale * curve.vertices @ turn.T)


def proved(a, b, options=COARSE):
    """A morph, its iterates, and the verdict of the independent check."""
    iterates = []
    result = morph(a, b, options, iterates.append)
    assert result.certified
    return result, iterates, check(iterates, Task.of(a))


@pytest.mark.parametrize(
    ("a", "b"),
    [
        (Curve(RECTANGLE), Curve(ZIGZAG)),
        (knot("3_1", 40), moved(smooth_knot("3_1", 50))),
        pytest.param(knot("4_1", 80), moved(knot("m4_1", 80), 0.01), marks=pytest.mark.slow),
        (knot("L4a1", 60), moved(knot("L4a1", 50))),
        (Curve([[0.0, 0], [3, 0], [3, 1], [0, 1]]), Curve([[5.0, 5], [6, 6 - 1e-8], [7, 7], [6, 6], [5, 7]])),
    ],
    ids=["unknots", "trefoils", "amphichiral", "link", "plane"],
)
def test_it_leads_from_one_to_the_other(a, b):
    result, iterates, _ = proved(a, b)
    assert result.status is Status.CONVERGED
    assert np.array_equal(iterates[0].curve.vertices, a.vertices)
    assert np.array_equal(result.curve.vertices, b.vertices)
    assert result.curve.mesh == b.mesh
    assert [each.index for each in iterates] == list(range(len(iterates)))
    assert result.final_energy > 0


def test_a_mirror_image_is_refused_before_anything_moves():
    with pytest.raises(
        NoMotionError, match=r"first curve is 3_1, the second curve its mirror image m3_1: no .* \(signatures"
    ):
        morph(knot("3_1"), knot("m3_1"), callback=lambda _: pytest.fail("something moved"))


@pytest.mark.parametrize(
    ("a", "b", "invariant"),
    [
        ("3_1", "4_1", "signatures −2 and 0"),
        ("4_1", "unknot", r"Alexander polynomials \[−1, 3, −1\] and \[1\]"),
        ("6_1", "m6_1", "different Jones polynomials"),
        ("hopf", "L4a1", r"linking numbers \[1\] and \[2\], without signs"),
        ("L5a1", "T(2,4)", "linking numbers"),
    ],
)
def test_the_invariant_that_tells_types_apart_is_named(a, b, invariant):
    a, b = (Curve(RECTANGLE) if name == "unknot" else knot(name) for name in (a, b))
    with pytest.raises(NoMotionError, match=invariant):
        morph(a, b)


def test_shapes_that_do_not_meet_are_told_with_their_energies():
    stopped = RelaxOptions(max_iterations=0, mesh="fixed")
    corners = [[x, y, z] for x in (-9.0, 9.0) for y in (-9.0, 9.0) for z in (-9.0, 9.0)]
    sides = [(0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5)]
    walls = Obstacle(corners, [side[:3] for side in sides] + [(side[0], *side[2:]) for side in sides])
    with pytest.raises(NoMotionError, match=r"no motion was found.* energies .* times their size"):
        morph(Task(curve=knot("3_1", 60), obstacles=(walls,)), moved(knot("3_1", 60), 0.1), stopped)


@pytest.mark.parametrize("misses", family([4, 1, 2, 3]))  # the most misses come after all fewer ones
def test_where_shapes_do_not_meet_both_go_on_with_equal_meshes_and_then_hop(misses, monkeypatch):
    module, asked = sys.modules["mobius_flow.core.driver.morph"], []

    def met(*shapes):
        asked.append([len(found[0].end.curve) for found in shapes[:2]])
        return meeting(*shapes) if len(asked) > misses else (None, None)

    monkeypatch.setattr(module, "meeting", met)
    options = replace(QUICK, hops=1, max_iterations=12)
    result, _, _ = proved(knot("4_1", 60), knot("4_1", 300), options)
    assert len(asked) == misses + 1
    assert asked[0][0] < asked[0][1] == 300
    assert asked[2:] == [[300, 300]] * (misses - 1)
    assert np.array_equal(result.curve.vertices, knot("4_1", 300).vertices)


@pytest.mark.parametrize(
    ("a", "b", "radius"),
    [
        (knot("L2a1", 40), moved(knot("L2a1", 50), 0.8), (0.1, 0.05)),
        (Curve(SQUARE), LARGER, "keep"),
        (knot("3_1", 40), moved(knot("3_1", 50), 0.2), "keep"),
    ],
    ids=["link", "plane", "knot"],
)
def test_it_is_a_rope_as_thick_as_the_thinner_end(a, b, radius):
    """Legs are those of a rope for the independent check, too."""
    result, iterates, verdict = proved(a, b, replace(COARSE, radius=radius))
    ends = [minimize(each, replace(COARSE, radius=radius, max_iterations=0)).last.radius for each in (a, b)]
    assert verdict.radius == result.last.radius
    assert result.last.radius == pytest.approx(tuple(map(min, *ends)))
    assert all(one.radius >= other.radius for one, other in pairwise(iterates))


@pytest.mark.parametrize(("share", "said"), [(0.8, "the rope gave way"), (0.0, "no way was found for a rope")])
def test_where_no_way_is_found_for_the_rope_it_gives_way(share, said, monkeypatch):
    """A radius that is asked for does not."""
    asked = [0.0]

    def refused(rope, *given):
        radius = 0.0 if rope.radius is None else rope.radius[0]
        asked.append(radius)
        return None if radius > 1.01 * share * max(asked) else prove_legs(rope, *given)

    monkeypatch.setattr(sys.modules["mobius_flow.core.driver.meeting"], "prove_legs", refused)
    result, _, _ = proved(Curve(SQUARE), LARGER, COARSE)
    assert said in result.message
    assert (result.last.radius is None) is (share == 0.0)
    asked[:] = [0.0]
    with pytest.raises(NoMotionError, match="a thinner rope"):
        morph(Curve(SQUARE), LARGER, replace(COARSE, radius=0.01))


def test_legs_are_those_of_the_rope():
    """A ring on its way to another may come near it, but not as a rope."""
    ring = np.array(SQUARE) @ np.eye(2, 3)
    near, still = (Curve.from_components([ring, ring + np.array([0.0, 0.0, z])]) for z in (0.1, 1.0))
    start = next(relax(still, replace(QUICK, mesh="fixed", vertices=8)))
    for radius, free in ((None, True), ((0.04, 0.04), True), ((0.06, 0.06), False)):
        legs = prove_legs(
            replace(start, radius=radius), still, lambda t: t * near.vertices + (1.0 - t) * still.vertices, 0.5
        )
        assert (legs is not None) is free


def test_every_leg_is_run_back():
    start = next(relax(Curve(RECTANGLE), QUICK))
    legs = tuple(start.curve.vertices + 0.1 * k for k in range(1, 4))
    way = [start, replace(start, curve=start.curve.with_vertices(legs[-1]), path=legs)]
    (there,) = run_back(way)
    assert [leg.tolist() for leg in there.path] == [each.tolist() for each in (legs[1], legs[0], start.curve.vertices)]
    assert there.curve is start.curve


def test_both_avoid_the_obstacles_of_the_first():
    wall = Obstacle([[-0.5, -2, -1], [-0.5, 3, -1], [-0.5, 0, 3]], [[0, 1, 2]])
    a = Task(curve=Curve(RECTANGLE), obstacles=(wall,))
    result, _, _ = proved(a, Curve(np.array(ZIGZAG) - [9, 9, 8]))
    assert np.array_equal(result.curve.vertices, np.array(ZIGZAG) - [9, 9, 8])


def test_arcs_are_held_at_their_ends():
    arcs = [
        Curve([[0.0, 0, 0], [1, 2, 0], [2, 2, 1], [3, 0, 0]], Mesh((4,), (False,))),
        Curve([[0.0, 0, 0], [1, 0, -2], [1.5, 1, -3], [2, 0, -2], [3, 0, 0]], Mesh((5,), (False,))),
    ]
    result, iterates, verdict = proved(*arcs, QUICK)
    assert verdict.pins == 2
    assert np.array_equal(result.curve.vertices, arcs[1].vertices)
    assert all(np.array_equal(each.curve.vertices[[0, -1]], arcs[0].vertices[[0, -1]]) for each in iterates)


WALL = Obstacle([[9.0, 0, 0], [9, 1, 0], [9, 0, 1]], [[0, 1, 2]])
CROSSING = Curve([[0.0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0]])


@pytest.mark.parametrize(
    ("a", "b", "said"),
    [
        (Curve(RECTANGLE), knot("hopf"), "^the first curve is 1 closed component, the second curve is 2 closed comp"),
        (Curve(RECTANGLE), overhand(), "is 1 closed component, the second curve is 1 open component; motions neither"),
        (Curve(RECTANGLE), Curve(np.eye(3)[:, :2]), "first curve is in dimension 3, the second curve in dimension 2"),
        (Task(curve=Curve(RECTANGLE), pins=(0,)), Curve(ZIGZAG), "leave pins out"),
        (Curve(RECTANGLE), Task(curve=Curve(ZIGZAG), obstacles=(WALL,)), "the second curve has obstacles of its own"),
        (overhand(), moved(overhand()), "move their ends together"),
        (CROSSING, Curve(RECTANGLE), r"^edge 1 .* touch"),
        (Curve(RECTANGLE), CROSSING, r"^the second curve: edge 1 .* touch"),
    ],
)
def test_what_no_motion_can_do_is_said(a, b, said):
    with pytest.raises((CurveError, OptionError), match=said):
        morph(a, b)


def test_the_time_may_be_up():
    result = morph(knot("3_1"), knot("3_1", 70), RelaxOptions(time_limit=1e-9))
    assert result.status is Status.TIME_LIMIT
