"""Hops lead lower or nowhere, by proved motions that a seed determines, and an interrupt loses nothing."""

from dataclasses import replace
from functools import cache
from itertools import cycle, islice, pairwise

import numpy as np
import pytest
from families import family
from mobius_flow.core import Curve, Iterate, Mesh, Obstacle, RelaxOptions, Status, minimize
from mobius_flow.core.collision import FreeMotion
from mobius_flow.core.curve import refine
from mobius_flow.core.driver.move import iterates
from mobius_flow.core.driver.moves import MOVES
from mobius_flow.core.driver.moves.hops import (
    IS_UNKNOT,
    MAY_BE_UNKNOT,
    MOTIONS,
    Hops,
    Stir,
    is_circle,
    radius,
    root_mean_square,
    unknot_message,
)
from mobius_flow.core.driver.prepare import start_problem
from mobius_flow.core.driver.relax import WithOutcome
from mobius_flow.core.driver.run import Run
from mobius_flow.core.knots import double, knot, overhand, torus_knot
from mobius_flow.lab import starts
from shapes import hopf_link, regular_polygon, torus_trefoil
from solids import plate
from tasks import check, wanted

VERTICES = 60
OPTIONS = RelaxOptions(radius="none", mesh="fixed", vertices=VERTICES, hops=1, seed=1)
SADDLE = torus_knot(3, 4, VERTICES)  # in its most symmetric position, where plain descent ends though it is no minimum


def run_of(options=OPTIONS, curve=SADDLE):
    return Run(start_problem(curve, options), curve, options)


def recorded(**changes):
    found: list[Iterate] = []
    return found, minimize(SADDLE, replace(OPTIONS, **changes), found.append)


@pytest.fixture(scope="module")
def hopped():
    return recorded()


@pytest.fixture(scope="module")
def plain():
    return recorded(hops=0)


def hop_of(found):
    """The first hop: the one iterate whose way is longer than any step's."""
    return max(found, key=lambda iterate: len(iterate.path))


def same(a, b):
    return all(np.array_equal(x.curve.vertices, y.curve.vertices) for x, y in zip(a, b, strict=True))


def test_a_hop_leads_lower_by_a_certified_way_and_is_told(hopped, plain):
    found, result = hopped
    assert result.status is Status.CONVERGED
    assert result.certified
    check(found)
    assert result.final_energy < 0.99 * plain[1].final_energy
    assert all(b.energy <= a.energy for a, b in pairwise(found))
    assert "hops that lowered the energy: 1 of 1" in result.message
    assert "hop" not in plain[1].message
    assert len(hop_of(found).path) > 20
    assert hop_of(found).edge_length_error < 1e-6


def test_without_hops_nothing_changes_and_with_them_nothing_before(hopped, plain):
    bare = list(iterates(run_of(), [each for each in MOVES if each is not Hops]))
    assert same(plain[0], bare)
    assert same(hopped[0][: len(bare)], bare)


def test_the_same_seed_gives_the_same_bits(hopped):
    run = run_of()
    again = WithOutcome(iterates(run, MOVES))
    assert same(hopped[0], list(again))
    assert again.outcome.message == hopped[1].message
    hop = hop_of(hopped[0])
    tried = len(hop.path)  # one leg each, since lengths are what they should be
    assert run.iterations == run.iterate.index + tried - 1, "the hop is one iterate, but all of its steps count"
    start = run_of(curve=hopped[0][hop.index - 1].curve).point
    first, other = (next(MOTIONS[0](start, np.random.default_rng(seed))).point.placed for seed in (1, 2))
    # modes need not converge, so that rounding shows: by a twentieth of what another seed changes
    apart, away = (np.abs(each - hop.path[0]).max() for each in (first, other))
    assert apart < 0.2 * away


def test_motions_take_turns_in_runs_and_in_starts_of_a_batch(monkeypatch):
    turns = []

    def still(motion, *_):
        turns.append(type(motion))
        return iter(())

    for each in MOTIONS:
        monkeypatch.setattr(type(each), "__call__", still)
    assert "hops that lowered the energy: 0 of 5" in recorded(hops=5)[1].message
    assert turns == list(islice(cycle(map(type, MOTIONS)), 5))
    turns.clear()
    for number in range(5, 12):
        starts.start("3_1", number, number)
    assert turns == list(islice(cycle(map(type, MOTIONS)), 4))


@pytest.mark.parametrize(
    ("error", "said"),
    [(KeyboardInterrupt, "interrupted: "), (np.linalg.LinAlgError, "; hops that lowered the energy: 0 of 1")],
)
def test_a_trial_that_fails_keeps_the_lowest_curve(error, said, plain, monkeypatch):
    def fails(*_):
        raise error

    monkeypatch.setattr(type(MOTIONS[0]), "__call__", fails)
    found, result = recorded()
    assert same(found, plain[0])
    assert said in result.message


def test_a_way_is_certified_only_if_all_its_steps_are():
    def unproved(point, rng):
        step = next(MOTIONS[0](point, rng))
        yield replace(step, legs=tuple(leg._replace(proof=FreeMotion(1.0, proved=False)) for leg in step.legs))

    for motion, certified in ((MOTIONS[0], True), (unproved, False)):
        run = run_of(replace(OPTIONS, max_iterations=2))
        Hops(run).hop(motion, np.inf)
        assert run.iterate.certified == certified


@pytest.mark.parametrize("left", family([0, 1, 10], every=2))
def test_iterations_of_trials_count(plain, left):
    """With too few of them for a trial to lead lower, the run stays where it has converged, and says so."""
    found, result = recorded(max_iterations=plain[1].last.index + left)
    assert same(found, plain[0])
    assert result.status is Status.CONVERGED
    assert ("hops that lowered the energy: 0 of 1" in result.message) == (left > 0)


def test_a_trial_takes_no_more_iterations_than_are_left(plain):
    """Its motion and its relaxation together."""
    run = run_of(replace(OPTIONS, max_iterations=plain[1].last.index + 10))
    list(WithOutcome(iterates(run, MOVES)))
    assert plain[1].last.index < run.iterations <= run.max_iterations


# -- where hops are pointless ----------------------------------------------------------------------------------------

STRAIGHT = Curve(np.linspace(0.0, 1.0, 13)[:, None] * [1.0, 2.0, 2.0], Mesh((13,), (False,)))


@pytest.mark.parametrize(
    ("curve", "options"),
    [
        (regular_polygon(40), {}),
        (STRAIGHT, {"vertices": 13, "mesh": "fixed"}),  # below which there is nothing
        (overhand(60), {}),  # straight in the end: a share of its energy is rounding
        (torus_trefoil(20), {"pins": tuple(range(20)), "vertices": 20, "mesh": "fixed"}),
        (torus_trefoil(60), {"method": "penalty-lbfgs", "tolerance": 1e-2}),
        (knot("3_1#3_1"), {"tolerance": 1e-2}),  # composite
    ],
    ids=["circle", "straight arc", "slack arc", "all pinned", "penalised lengths", "composite"],
)
def test_where_there_is_nothing_to_look_for_nothing_hops(curve, options):
    message = minimize(*wanted(curve, hops=2, **options)).message
    assert "hop" not in message
    assert ("composite" in message) == (curve.mesh.size > 60 and "tolerance" in options)


def test_hops_keep_pins_move_nothing_that_lengths_hold_and_may_leave_a_circle_that_is_held():
    """Only where nothing is in the way has no curve less energy."""
    task, options = wanted(regular_polygon(16), hops=1, pins=(0, 8), vertices=16, mesh="fixed", tolerance=1e-2)
    assert "of 1" in minimize(task, options).message
    # a vertex in the plane between two pins, at given distances from both, moves neither way
    arc = overhand(60)
    result = minimize(*wanted(arc, pins=(0, 59), hops=1, max_iterations=90))
    assert "hops that lowered" in result.message or result.status is Status.ITERATION_LIMIT
    np.testing.assert_array_equal(result.curve.vertices[list(result.last.pins)], arc.vertices[[0, 59]])
    corner = Curve.from_components([[[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]]], [False])
    result = minimize(*wanted(corner, pins=(0, 2), vertices=3, hops=1, max_iterations=5))
    np.testing.assert_array_equal(result.curve.vertices, corner.vertices)


# -- motions ---------------------------------------------------------------------------------------------------------


@cache
def saddle(**options):
    return run_of(RelaxOptions(mesh="fixed", vertices=VERTICES, **options)).point


@pytest.mark.parametrize("motion", MOTIONS, ids=lambda motion: type(motion).__name__)
def test_motions_stay_on_the_constraints_below_their_ceilings_and_go_far(motion):
    start = saddle()
    steps = list(motion(start, np.random.default_rng(0)))
    assert len(steps) > 20
    assert all(step.certified and step.point.infeasibility < 1e-9 for step in steps)
    assert max(step.point.energy for step in steps) < 16.0 * start.energy
    assert root_mean_square(steps[-1].point.vertices - start.vertices) > 0.5 * radius(start.vertices)
    low = list(type(motion)(ceilings=(1.02, 1.02))(start, np.random.default_rng(0)))
    assert 1.0 < max(step.point.energy for step in low) / start.energy < 1.02


def test_motions_fit_where_lengths_are_prescribed():
    assert all(motion.fits(saddle(energy=energy)) for motion in MOTIONS for energy in ("moebius", "edge"))
    assert not any(motion.fits(saddle(method="penalty-lbfgs")) for motion in MOTIONS)


def test_flows_have_no_divergence_and_what_constraints_hold_back_moves_nothing():
    flow = Stir().field(saddle(), np.random.default_rng(0))
    x, h = np.array([[0.3, -0.2, 0.1]]), 1e-5
    divergence = sum((flow(x + h * e)[0] - flow(x - h * e)[0]) @ e for e in np.eye(3)) / (2.0 * h)
    assert abs(divergence) < 1e-8
    # what is left of a translation, with the barycenter held, is rounding errors
    assert not list(Stir().along(saddle(), np.ones_like, np.inf))


def test_a_way_is_as_long_as_asked_and_steps_grow_again_where_there_is_room():
    """From a start with little room below the ceiling, and then turning about an axis, which costs nothing."""
    start, stride = saddle(), 0.2
    rough = np.random.default_rng(4).normal(size=start.vertices.shape)

    def field(x):
        return rough if np.array_equal(x, start.vertices) else np.cross([0.0, 0.0, 1.0], x)

    steps = list(Stir(stride=stride, shortest=1e-3).along(start, field, 1.02 * start.energy))
    places = [start.vertices, *(step.point.vertices for step in steps)]
    ways = [root_mean_square(b - a) / radius(a) for a, b in pairwise(places)]
    assert ways[0] < 0.6 * stride
    assert max(ways) == pytest.approx(stride, rel=0.1)
    assert 1.0 - stride < sum(ways) < 1.0 + stride


# -- unknots that are no circles -------------------------------------------------------------------------------------


@pytest.mark.parametrize(("hops", "advice"), [(0, "hops may reach it"), (1, "more hops may reach it")])
def test_an_unknot_above_the_circle_is_never_called_done(hops, advice):
    at_rest = RelaxOptions(tolerance=1e6, edge_lengths="keep", mesh="fixed", max_iterations=1, hops=hops)
    result = minimize(knot("culprit"), at_rest)
    assert result.status is Status.CONVERGED
    assert result.message.endswith(f"; {IS_UNKNOT}: {advice}")


def test_no_hop_is_recommended_to_what_is_confined():
    """A circle pressed flat between walls is an unknot and no circle, and can become none."""
    ellipse = regular_polygon(60).with_vertices(regular_polygon(60).vertices * [2.0, 0.4, 1.0])
    walls = [Obstacle(wall.vertices[:, [0, 2, 1]], wall.faces) for wall in (plate(0.5), plate(-0.5))]
    result = minimize(*wanted(ellipse, avoid=walls))
    assert result.status is Status.CONVERGED
    assert "unknot" not in result.message


@pytest.mark.parametrize(
    ("curve", "said"),
    [
        (double(knot("3_1"), 0), MAY_BE_UNKNOT),  # knotted, with Δ = 1, and of too many crossings for the table
        # strands pass at 10⁻¹² of its size, as they may where a curve is stuck: no view tells which is in front
        (Curve([[-1, -1, 0], [1, 1, 1e-12], [2, 0, 0], [1, -1, 0], [-1, 1, 0], [-2, 0, 0]]), MAY_BE_UNKNOT),
        (refine(knot("culprit"), 10_000), IS_UNKNOT),
        (refine(knot("culprit"), 10_001), None),  # not looked at
        (knot("8_19"), None),
        (hopf_link(40), None),
        (regular_polygon(40), None),
        (regular_polygon(40, dimension=2), None),
    ],
    ids=["double", "eight", "culprit", "too many", "8_19", "link", "circle", "plane"],
)
def test_unknots_are_told_from_what_may_be_one(curve, said):
    assert unknot_message(curve) == said


def test_a_circle_is_told_from_what_is_wound_like_one():
    angles = np.sort(np.random.default_rng(3).uniform(0.0, 2.0 * np.pi, 60))
    uneven = np.stack([np.cos(angles), np.sin(angles), 0.0 * angles], axis=1)
    assert is_circle(Curve(uneven))
    assert is_circle(Curve(100.0 + uneven @ np.linalg.qr(np.arange(9.0).reshape(3, 3) ** 2)[0]))
    assert not any(map(is_circle, (Curve(uneven * [1.0, 0.5, 1.0]), torus_knot(9, 2, 400), hopf_link(40))))
