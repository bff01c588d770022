"""A hand that drags: the term that it is, where the curve goes, and what it never does, however violent it is."""

from dataclasses import replace

import numpy as np
import pytest
from descent_contracts import point_on
from families import family
from mobius_flow.core import Hand, MobiusFlowError, RelaxOptions, Status, Task, WithOutcome, relax
from mobius_flow.core.energies.pull import REACH, Pull, share_of
from mobius_flow.core.knots import knot, knot_type
from shapes import hopf_link, opened, regular_polygon, torus_trefoil
from smooth_curves import random_polygon
from solids import plate
from tasks import check
from taylor import derivative_slope, hessian_slope

CURVES = {
    "knot": random_polygon(3, (13,), 3),
    "link": random_polygon(5, (7, 5), 3),
    "plane": random_polygon(5, (9,), 2),
    "open": opened(random_polygon(5, (7, 5), 3), 1),
}
FIXED = {"vertices": 60, "mesh": "fixed"}


def pulled(curve, away=1.0, component=0):
    pull = Pull.at(curve, component, 0.3, 40.0)
    return replace(pull, target=pull.target + away * np.arange(1.0, curve.dimension + 1.0))


@pytest.mark.parametrize("curve", CURVES.values(), ids=CURVES)
def test_derivatives_of_the_pull_and_a_stiffness_that_is_no_less(curve):
    v, stiffness = np.random.default_rng(5).normal(size=curve.vertices.shape), pulled(curve).stiffness(curve).toarray()
    for away in (0.0, 0.1, 30.0):
        pull = pulled(curve, away)
        assert derivative_slope(pull, curve, v, largest=0.3) == pytest.approx(2, abs=0.02)
        assert hessian_slope(pull, curve, v, largest=0.3) >= 2.98  # even in the displacement where the force is 0
        matrix = pull.sparse_hessian(curve)
        np.testing.assert_allclose((matrix @ v.ravel()).reshape(v.shape), pull.hessian_product(curve, v), atol=1e-10)
        np.testing.assert_array_equal(pull.stiffness(curve).toarray(), stiffness, "it knows no target")
        more = np.kron(stiffness, np.eye(curve.dimension)) - matrix.toarray()
        assert np.linalg.eigvalsh(more).min() > -1e-12 * stiffness.max()
    assert stiffness.sum() == pytest.approx(40.0)


def test_the_force_is_bounded_and_that_of_a_spring_nearby():
    curve = regular_polygon(50)
    for away, force in ((1e-6, 1e-6 * np.sqrt(14.0) * 40.0), (1e9, REACH * 40.0)):
        _, derivative = pulled(curve, away).value_and_derivative(curve)
        assert np.linalg.norm(derivative.sum(axis=0)) == pytest.approx(force, rel=1e-6)


@pytest.mark.parametrize("solver", ["dense", "hierarchical"])
def test_the_metric_has_the_stiffness(solver):
    curve = torus_trefoil(60)
    point = point_on(curve, solver=solver)
    pull = Pull.at(point.curve, 0, 0.3, 40.0)
    plain, held = (each.inner_product.dense() for each in (point, point.pulled(pull)))
    np.testing.assert_allclose(held - plain, pull.stiffness(curve).toarray(), atol=1e-9 * np.abs(plain).max())


def test_what_a_moved_target_keeps_is_what_would_be_computed_anew():
    point = point_on(torus_trefoil(60))
    pull = Pull.at(point.curve, 0, 0.3, 40.0)
    held = point.pulled(pull)
    held.gradient  # noqa: B018 (computed)
    moved = held.pulled(replace(pull, target=pull.target + 0.2))
    anew = moved.problem.at(moved.vertices)
    assert moved.tangent_space is held.tangent_space
    assert moved.energy == pytest.approx(anew.energy, rel=1e-13)
    np.testing.assert_allclose(moved.gradient, anew.gradient, atol=1e-10)
    gone = moved.pulled(None)
    assert gone.energy == pytest.approx(point.energy, rel=1e-14)
    np.testing.assert_allclose(gone.gradient, point.gradient, atol=1e-10)


@pytest.mark.parametrize("curve", [hopf_link(40), opened(hopf_link(40), 1)], ids=["closed", "open"])
def test_shares_of_lengths_are_found_again(curve):
    for component in (0, 1):
        for share in (0.1, 0.35, 0.8):
            pull = Pull.at(curve, component, share, 1.0)
            assert pull.weights.sum() == pytest.approx(1.0)
            assert share_of(curve, component, curve.vertices[pull.vertex]) == pytest.approx(share, abs=0.02)
            assert curve.mesh.component[pull.vertex] == component


def drag(curve, hand, moves, **settings):
    """The iterates of a run in which something is done to the hand at some of them."""
    run, iterates = WithOutcome(relax(curve, RelaxOptions(**FIXED | settings), hand=hand)), []
    for iterate in run:
        del iterates[iterate.index :]
        iterates.append(iterate)
        if iterate.index in moves:
            moves.pop(iterate.index)(hand, iterate)
    assert run.outcome is not None
    return iterates, run.outcome


def held(hand, _iterate):
    hand.grab(0, 0.25)


def pulled_out(hand, iterate):
    hand.move(place_outside(iterate.curve))


def place_outside(curve):
    middle = curve.vertices.mean(axis=0)
    return middle + 1.5 * (Pull.at(curve, 0, 0.25, 1.0).target - middle)


@pytest.mark.parametrize("settings", family([{"mesh": "adaptive"}, {}, {"solver": "hierarchical"}]), ids=str)
def test_the_curve_follows_rests_and_relaxes_on(settings):
    moves = {2: held, 3: pulled_out}
    rested, outcome = drag(knot("3_1"), Hand(), dict(moves), **settings)
    curve = rested[-1].curve
    assert outcome.converged
    assert "a hand holds it" in outcome.message
    reached, wanted = Pull.at(curve, 0, 0.25, 1.0).target, place_outside(rested[3].curve)
    assert np.linalg.norm(reached - wanted) < 0.03 * curve.length
    free, outcome = drag(knot("3_1"), Hand(), moves | {40: lambda hand, _: hand.release()}, **settings)
    assert outcome.converged
    # Möbius images have the same energy, which hands may choose, but not on the same mesh
    assert free[-1].energy == pytest.approx(rested[-1].energy, rel=2e-3)
    for iterates in (rested, free):
        check(iterates)


def test_what_is_held_does_not_end_and_its_energies_are_those_without_the_hand():
    moves = {2: held, 3: pulled_out, 25: lambda hand, _: hand.release()}
    iterates, outcome = drag(torus_trefoil(60), Hand(), moves, max_iterations=15)
    assert len(iterates) > 25
    assert "rose" not in outcome.message
    for iterate in iterates[3:40:7]:
        problem = point_on(iterate.curve).problem
        assert iterate.energy == pytest.approx(problem.at_curve(iterate.curve).energy, rel=1e-9)


def test_at_rest_the_run_asks_once_more_and_then_ends():
    hand, rests = Hand(stays=True), []
    run = WithOutcome(relax(regular_polygon(60), RelaxOptions(**FIXED), hand=hand))
    for iterate in run:
        if hand.rests:
            rests.append(iterate.index)
            np.testing.assert_array_equal(iterate.path[-1], iterate.curve.vertices)
            if len(rests) == 1:
                hand.grab(0, 0.0)
                hand.move([0.5, 0.0, 0.0])
            elif len(rests) == 2:
                hand.release()
    assert len(rests) == 3
    assert run.outcome.status is Status.CONVERGED
    assert rests == sorted(set(rests))


def test_a_pin_is_left_where_the_hand_lets_go_and_undo_takes_the_drag_back_with_it():
    plain, _ = drag(knot("4_1"), Hand(), {}, vertices=80)
    pinned = []

    def undone(hand, _iterate):
        hand.undo()
        hand.undo()  # there is nothing else

    moves = {8: held, 9: pulled_out, 20: lambda hand, each: (pinned.append(each), hand.release(pin=True))}
    moves |= {k: lambda _, each: pinned.append(each) for k in range(21, 25)} | {25: undone}
    again, outcome = drag(knot("4_1"), Hand(), moves, vertices=80)
    (pin,) = pinned[1].pins
    assert [each.pins for each in pinned] == [(), *[(pin,)] * 4]
    for each in pinned:
        np.testing.assert_array_equal(each.curve.vertices[pin], pinned[0].curve.vertices[pin])
    assert outcome.converged
    assert again[-1].pins == ()
    np.testing.assert_array_equal(again[8].curve.vertices, plain[8].curve.vertices)
    assert again[-1].energy == pytest.approx(plain[-1].energy, rel=1e-5)
    check(again)


@pytest.mark.parametrize("mesh", ["adaptive", "finer"])
def test_undo_goes_back_to_the_mesh_that_there_was(mesh):
    """A curve that is pulled far is given other vertices; those from before are there again, and the run goes on."""
    hand, seen, undone = Hand(), [], False
    for iterate in relax(torus_trefoil(60), RelaxOptions(vertices=60, mesh=mesh, tolerance=1e-3), hand=hand):
        if undone and iterate.index == 4:
            assert iterate.curve.mesh == seen[3].curve.mesh
        del seen[iterate.index :]
        seen.append(iterate)
        if iterate.index == 3 and not undone:
            hand.grab(0, 0.25)
        if iterate.index >= 3 and not undone:
            hand.move(seen[3].curve.vertices[15] + 0.2 * (iterate.index - 3) * np.array([0.0, 0.0, 1.0]))
            if iterate.curve.mesh != seen[3].curve.mesh:
                hand.undo()
                undone = True
    assert undone, "the mesh has changed under the hand"
    check(seen)


def test_what_is_no_place_or_no_point_is_refused():
    hand = Hand()
    for component, share in [(0, -0.1), (0, 1.1), (0, np.nan), ("x", 0.1), (0.5, 0.1)]:
        with pytest.raises(MobiusFlowError):
            hand.grab(component, share)
    for target in ([np.nan, 0.0, 0.0], [np.inf, 0, 0], [1e50, 0, 0], "x", None, [], 3.0, [[0, 0, 0]]):
        with pytest.raises(MobiusFlowError, match="finite coordinates"):
            hand.move(target)


@pytest.mark.parametrize(
    ("component", "target", "said"),
    [(1, [], "component is 1"), (-1, [], "component is -1"), (0, [1.0, 2.0], "target has 2 coordinates; give 3")],
)
def test_what_does_not_fit_the_curve_ends_the_run_in_a_sentence(component, target, said):
    def grab(hand, _iterate):
        hand.grab(component, 0.5)
        if target:
            hand.move(target)

    with pytest.raises(MobiusFlowError, match=said):
        drag(torus_trefoil(60), Hand(), {1: grab})


def test_what_is_pinned_stays_and_a_hand_that_holds_nothing_does_nothing():
    task = Task(curve=torus_trefoil(60), pins=tuple(range(60)))
    iterates, _ = drag(task, Hand(), {0: held})
    assert all(np.array_equal(iterate.curve.vertices, task.curve.vertices) for iterate in iterates)
    plain, _ = drag(torus_trefoil(60), Hand(), {})
    idle, _ = drag(torus_trefoil(60), Hand(), {2: pulled_out, 3: lambda hand, _: hand.release(pin=True)})
    assert idle[-1].energy == plain[-1].energy


WALLS = (plate(1.2, name="ceiling"), plate(-1.2, name="floor"))
TASKS = {
    "trefoil": (Task(curve=knot("3_1")), {"vertices": 60}),
    "twist knot": (Task(curve=knot("5_2")), {"vertices": 100}),
    "link": (Task(curve=hopf_link(40)), {"vertices": 80}),
    "arcs": (Task(curve=opened(hopf_link(40), 1)), {"vertices": 80}),
    "walls": (Task(curve=torus_trefoil(60), obstacles=WALLS), {"vertices": 60}),
    "pins": (Task(curve=torus_trefoil(60), pins=(0, 7, 33)), {"vertices": 60}),
    "adaptive": (Task(curve=torus_trefoil(60)), {"vertices": 60, "mesh": "adaptive"}),
    "finer": (Task(curve=knot("4_1")), {"vertices": 80, "mesh": "finer"}),
}


def violent(task, options, drags, seed):
    """The iterates of a run with so many drags: slow, jumping, jittering, far out, into strands, and nonsense."""
    rng, hand, iterates = np.random.default_rng(seed), Hand(stays=True), []
    busy, left, kind, way = False, 2, 0, np.zeros(3)
    for iterate in relax(task, options, hand=hand):
        del iterates[iterate.index :]
        iterates.append(iterate)
        curve, left = iterate.curve, left - 1
        size, middle = curve.component_lengths.mean(), curve.vertices.mean(axis=0)
        if busy and left > 0 and not hand.rests:
            targets = (
                middle + way * size * (0.6 - 0.05 * left),
                middle + 10.0 * size * rng.normal(size=3),
                middle + 1e30 * way,
                curve.vertices[rng.integers(len(curve))],
                middle - 0.3 * size * way,
            )
            hand.move(targets[kind])
            with pytest.raises(MobiusFlowError):
                hand.move([np.nan, 0.0, np.inf])
        elif left <= 0 or hand.rests:
            if busy:
                ends = rng.random()
                hand.undo() if ends < 0.1 else hand.release(pin=ends < 0.3 and len(iterate.pins) < 5)
                drags, left = drags - 1, int(rng.integers(1, 6))
            elif drags == 0:
                break
            else:
                hand.grab(int(rng.integers(len(curve.mesh.component_sizes))), float(rng.random()))
                left, kind, way = int(rng.integers(2, 12)), int(rng.integers(5)), rng.normal(size=3)
                way /= np.linalg.norm(way)
            busy = not busy
    return iterates


@pytest.mark.parametrize("drags", [4, pytest.param(130, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", TASKS)
def test_violent_drags_go_through_nothing(name, drags):
    """With the slow ones they are a thousand."""
    task, settings = TASKS[name]
    iterates = violent(task, RelaxOptions(**{"mesh": "fixed"} | settings), drags, 7)
    assert all(iterate.certified for iterate in iterates)
    check(iterates, task)
    if task.curve.mesh.all_closed:
        assert knot_type(iterates[-1].curve).names == knot_type(task.curve).names
