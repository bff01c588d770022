"""Runs that keep a rope: its radius is kept, gives way where that leads on, and is refused where it cannot be."""

from copy import copy
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from mobius_flow.core import Curve, CurveError, Obstacle, OptionError, RelaxOptions, Task, minimize
from mobius_flow.core.collision import Contact, is_rope, thickness
from mobius_flow.core.curve import halved
from mobius_flow.core.curve.measures import bending_radii
from mobius_flow.core.descent import NoStep, Step
from mobius_flow.core.driver.moves.balance import Balance
from mobius_flow.core.driver.moves.remesh import split_edges
from mobius_flow.core.driver.moves.rope import GiveWay
from mobius_flow.core.driver.relax import begin
from mobius_flow.core.energies.pull import Pull
from mobius_flow.core.energies.rope import Rope
from mobius_flow.core.knots import knot, overhand, torus_knot
from shapes import regular_polygon
from tasks import proved

GROWN = 0.9 * thickness(torus_knot(2, 3, 60))  # what grows has a radius only if it is asked for
WALL = Obstacle([[-9.0, -9, 0], [9, -9, 0], [0, 18, 0]], [[0, 1, 2]])


def kept(task, **options):
    """The least thickness of all iterates over that of the start; each leg is that of the rope of the last radius."""
    iterates = []
    result = minimize(task, RelaxOptions(**options), callback=iterates.append)
    assert result.certified
    assert result.last.radius is not None
    radius = np.array(result.last.radius)
    for before, after in pairwise(iterates):
        way = [before.curve.vertices, *after.path]
        for start, end in pairwise(way):
            assert is_rope(after.curve.mesh, start, end, 0.999 * radius, task.obstacles)
    assert result.least_thickness == pytest.approx(min(thickness(each.curve) for each in iterates))
    assert result.report()["radius"] == list(radius)
    return result.least_thickness / thickness(iterates[0].curve)


@pytest.mark.parametrize(
    ("task", "options"),
    [
        (Task(curve=knot("goeritz")), {}),
        (Task(curve=knot("L6a4", 120)), {"max_iterations": 20}),
        (Task(curve=overhand(60), pins=(0, 59), pin_tangents=True), {}),
        (Task(curve=knot("4_1", 80), obstacles=(WALL,)), {"max_iterations": 10}),
        (Task(curve=knot("5_2", 300)), {"solver": "hierarchical", "max_iterations": 12}),
        (
            Task(curve=torus_knot(2, 3, 60)),
            {"radius": GROWN, "grow": 1.2, "mesh": "fixed", "vertices": 60, "max_iterations": 25},
        ),
    ],
    ids=["unknot", "link", "arc", "obstacle", "hierarchical", "growth"],
)
def test_nine_tenths_of_the_thickness_are_kept(task, options):
    task = Task(
        curve=task.curve.with_vertices(task.curve.vertices + np.array([0, 0, 4.0 if task.obstacles else 0.0])),
        obstacles=task.obstacles,
        pins=task.pins,
        pin_tangents=task.pin_tangents,
    )
    assert kept(task, **options) >= 0.89


def test_without_a_rope_it_gets_thinner():
    iterates = []
    minimize(knot("goeritz"), RelaxOptions(radius="none"), callback=lambda each: iterates.append(each.curve))
    assert min(map(thickness, iterates)) < 0.6 * thickness(iterates[0])


def test_radii_of_components():
    link = knot("L6a4", 120)
    result = minimize(link, RelaxOptions(radius=(0.05, 0.1, 0.02), max_iterations=8))
    assert result.last.radius == (0.05, 0.1, 0.02)


def test_the_radius_gives_way_where_it_is_in_its_own_way():
    """So that it ends no higher than without a rope; 8_10 has a strand that wants to be thin."""
    start, options = knot("8_10", 70), {"vertices": 70, "mesh": "fixed"}
    free, rope = (minimize(start, RelaxOptions(radius=each, **options)) for each in ("none", "keep"))
    assert rope.final_energy <= (1 + 5e-4) * free.final_energy
    assert "the rope gave way from radius" in rope.message
    assert rope.last.radius[0] < 0.8 * thickness(start)


@pytest.mark.parametrize(("left", "steps"), [(1.0, None), (0.1, GiveWay.patience), (1e-9, 1)])
def test_it_lets_go_where_it_takes_much_of_the_flow(left, steps):
    """In step after step, but at once at rest; and stays a rope by its proof, also on another mesh."""
    run = begin(Task.of(knot("3_1", 60)), RelaxOptions(radius="keep", vertices=60, mesh="fixed"))
    step, before = run.step(), run.point
    assert isinstance(step, Step)
    run.point = copy(before)
    run.point._energy_and_derivative = before.energy, left * before.derivative
    del run.point._gradient_and_multipliers, run.point.gradient_norm
    move = GiveWay(run)
    answers = [move.stepped(step) for _ in range(GiveWay.patience + 1)]
    assert next((k for k, answer in enumerate(answers, 1) if answer), None) == steps
    if steps:
        there = answers[steps - 1].point.problem
        assert there.objective.rope is None
        finer = there.on(halved(before.curve.with_vertices(before.placed))).problem
        assert finer.objective.rope is None
        assert (finer.radius == before.problem.radius).all()


def test_what_a_thinner_rope_promises():
    """−⟨P, ∂E/∂P⟩ is r ∂E/∂r, by Euler's theorem, and 2 E more for the lengths by which pairs of strands weigh."""
    curve = knot("4_1", 150)
    radius = np.array([0.8 * thickness(curve)])
    rope = Rope(radius).frozen_at(curve)
    thick, thin = (Rope(share * radius).value(curve) for share in (1.0001, 0.9999))
    promise = -np.sum(rope.value_and_derivative(curve)[1] * curve.vertices)
    assert promise == pytest.approx((thick - thin) / 2e-4 + 2.0 * rope.value(curve), rel=1e-3)


@pytest.mark.parametrize("name", ["4_1", "L6a4", "goeritz"])
def test_edges_of_a_rope_are_split_as_its_bending_radii_bear(name):
    """Without a rope corners get radii a quarter as large."""
    task = Task.of(knot(name))
    for radius in ("keep", "none"):
        problem = begin(task, RelaxOptions(radius=radius)).problem
        curve, rope = task.curve, problem.radius
        finer = split_edges(problem, curve, np.full(curve.mesh.edges, 4))
        least = bending_radii(Curve(finer.placed, finer.problem.mesh)).min()
        if rope is None:
            assert least == pytest.approx(bending_radii(curve).min() / 4, rel=1e-6)
        else:
            assert least >= (1 - 1e-9) * rope.min()


def test_sharp_corners_leave_a_thinner_rope_or_none():
    """Near a corner of 120° strands come nearer than two radii, as far along as half a circle is long."""
    triangle = Curve([[0.0, 0, 0], [1, 0, 0], [0.5, 0.75**0.5, 0]])
    result = minimize(triangle, RelaxOptions(max_iterations=3))
    assert result.certified
    assert result.last.radius is not None
    assert np.isfinite(result.energies).all()


def test_a_given_radius_does_not_give_way():
    start = knot("8_10", 100)
    radius = 0.95 * thickness(start)
    result = minimize(start, RelaxOptions(radius=radius, vertices=100, mesh="fixed", max_iterations=80))
    assert result.last.radius == (radius,)


@pytest.mark.parametrize(
    ("options", "error", "said"),
    [
        ({"radius": 1.0}, CurveError, r"no rope of radius 1: it bends too sharply near \("),
        ({"radius": 1e6}, CurveError, "it is one of radius"),
        ({"radius": (0.1, 0.2)}, OptionError, "give one, or one for each component, of which there is one"),
        ({"radius": 0.1, "method": "penalty-lbfgs"}, OptionError, "radius needs lengths that stay"),
    ],
)
def test_what_cannot_be(options, error, said):
    with pytest.raises(error, match=said):
        minimize(knot("4_1", 60), RelaxOptions(**options))


@pytest.mark.parametrize(("heights", "why"), [((0.05, 1.0), "obstacle is in the way"), ((0.4, 0.5), "strands are too")])
def test_why_a_radius_is_refused(heights, why):
    rings = [regular_polygon(40).vertices + np.array([0, 0, z]) for z in heights]
    with pytest.raises(CurveError, match=f"{why}.*one of radius"):
        minimize(Task(curve=Curve.from_components(rings), obstacles=(WALL,)), RelaxOptions(radius=0.1))


TRIANGLE = Curve([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])


def test_coarse_polygons_have_a_radius_that_is_told():
    first = minimize(TRIANGLE, RelaxOptions(max_iterations=1)).last
    assert np.isfinite(first.energy)
    with pytest.raises(CurveError, match=f"it is one of radius {first.radius[0]:.4g}") as error:
        minimize(TRIANGLE, RelaxOptions(radius=1.4 * first.radius[0]))
    assert not error.value.place.vertices, "the user knows none of the refined curve"


def test_far_from_the_origin_it_is_a_rope_too():
    result, _ = proved(Curve(1e9 + np.round(knot("3_1", 60).vertices, 3)), max_iterations=1)
    assert result.last.radius is not None


@pytest.mark.parametrize("radius", [0.0, -1.0, float("nan"), float("inf"), "thick", (), (0.1, 0.0)])
def test_what_is_no_radius(radius):
    with pytest.raises(OptionError, match="radius"):
        RelaxOptions(radius=radius)


def test_strands_of_a_rope_move_as_its_radius_allows():
    assert kept(Task.of(knot("goeritz")), radius="keep", untangle="always", max_iterations=1) > 0.89


def test_no_rope_is_thicker_for_its_length_than_a_hopf_links():
    """A circle's would fill it, so that it could not move; what grows has none."""
    circle = regular_polygon(60)
    radius = minimize(circle, RelaxOptions(max_iterations=0)).last.radius
    assert radius == pytest.approx((0.9 * circle.length / (8.0 * np.pi),))
    assert minimize(circle, RelaxOptions(grow=1.1, max_iterations=0)).last.radius is None


def test_a_rope_that_keeps_its_thickness_outlasts_balance():
    curve = minimize(torus_knot(2, 3, 60), RelaxOptions(radius="none", vertices=60)).curve
    away = curve.vertices - np.array([1.2, 0.0, 0.5])  # an inversion near the knot
    uneven = Curve(3 * away / np.square(away).sum(axis=1, keepdims=True))
    iterates = []
    options = RelaxOptions(balance=True, vertices=60, mesh="fixed", tolerance=1e-3)
    result = minimize(uneven, options, iterates.append)
    assert "balanced" in result.message
    assert 0.0 < iterates[-1].radius[0] <= iterates[0].radius[0]
    run = begin(Task.of(uneven), options)
    for objective in (run.problem.objective, run.problem.objective.having(Rope, None)):  # or has let go, and stays so
        *_, step = Balance(run).way(run.point.changing(objective=objective))
        assert (step.point.problem.objective.rope is None) == (objective.rope is None)


def test_a_curve_at_rest_by_itself_stays():
    """Though it is a rope that is hardly thinner than its own thickness."""
    rest = minimize(knot("4_1", 60), RelaxOptions(radius="none", vertices=60, mesh="fixed")).curve
    again = minimize(rest, RelaxOptions(vertices=60, mesh="fixed"))
    assert again.outcome.converged
    assert again.iterations == 0
    assert again.last.radius == (0.9 * thickness(rest),)


def test_a_rope_that_has_let_go_gives_way_where_its_proof_is_in_the_way_but_not_to_a_hand():
    run = begin(Task.of(knot("3_1", 60)), RelaxOptions(radius="keep", vertices=60, mesh="fixed"))
    step, contact, before = run.step(), Contact((0, 30)), run.point
    assert isinstance(step, Step)
    run.view(before.changing(objective=before.problem.objective.having(Rope, None)))
    move = GiveWay(run)
    assert move.stepped(replace(step, limited_by=None)) is None
    assert move.stuck(NoStep("no step")) is None
    for change in (move.stepped(replace(step, limited_by=contact)), move.stuck(NoStep("no step", contact))):
        assert change.point.problem.objective is run.problem.objective, "so that the method remembers what it did"
        assert (change.point.problem.radius < before.problem.radius).all()
    for point in (run.point, before):
        run.view(point.pulled(Pull.at(point.curve, 0, 0.25, 5.0)))
        assert GiveWay(run).stuck(NoStep("no step", contact)) is None


def test_a_rope_lets_go_only_where_it_acts():
    """Where a run is stuck for other reasons, a rope that touches nothing stays as it is."""
    run = begin(Task.of(knot("3_1", 60)), RelaxOptions(radius="keep", vertices=60, mesh="fixed"))
    stuck, point = NoStep("no step"), run.point
    change = GiveWay(run).stuck(stuck)
    assert change.point.problem.objective.rope is None
    assert (change.point.problem.radius == point.problem.radius).all()
    thin = point.problem.as_rope(0.1 * np.asarray(point.problem.radius))
    run.view(point.changing(objective=thin.objective, radius=thin.radius))
    assert GiveWay(run).stuck(stuck) is None
