"""Curves become ropes that keep clear: who goes over whom, how far they move, what is proved, where it is tight."""

import numpy as np
import pytest
from bundles import bundle, least_distance
from mobius_flow.core import Curve, MobiusFlowError, Obstacle, Status, Task, separate
from mobius_flow.core.collision import is_rope
from mobius_flow.core.ropes import SeparateOptions
from mobius_flow.core.ropes.clearances import clearances
from mobius_flow.core.ropes.displacement import Ropes, stiffness
from shapes import regular_polygon
from tasks import check
from taylor import taylor_slope

WALL = Obstacle([[-3.0, -9, 1.6], [-3, 9, 1.6], [9, 0, 1.6]], [[0, 1, 2]], "wall")
GATE = Obstacle([[-1.0, 3, -1], [1, 3, -1], [0, 3, 1]], [[0, 1, 2]], "gate")
STICK = Obstacle([[-12.0, 0.5, 0], [-12, 9, 0]], [[0, 1]], "stick")
POST = Obstacle([[0.9, 0.9, -9], [0.9, 0.9, 9]], [[0, 1]], "post")


def line(start, end, points=21):
    t = np.linspace(0.0, 1.0, points)[:, None]
    return (1.0 - t) * np.array(start, float) + t * np.array(end, float)


def ring(radius=8.0, points=80, tilt=0, centre=(0.0, 0.0, 0.0)):
    return np.roll(radius * regular_polygon(points).vertices, tilt, axis=1) + np.array(centre)


def arcs(*parts):
    return Curve.from_components(parts, [False] * len(parts))


X, Y = line((-12, 0, 0), (12, 0, 0)), line((0, -12, 0), (0, 12, 0))
S = np.linspace(-1.0, 1.0, 41)[:, None]
SLACK = arcs(
    np.hstack([14 * S, 0 * S, 4 * np.cos(np.pi * S / 2)]), np.hstack([0 * S, 14 * S, 8 - 4 * np.cos(np.pi * S / 2)])
)
LINKED = Curve.from_components([ring(5.0, 40), ring(5.0, 40, tilt=2, centre=(5.0, 0, 0))])
SAG = 0.3 * np.cos(np.pi * np.linspace(-0.5, 0.5, 21))[:, None] * [0, 0, 1]
NEARLY_TAUT = arcs(X + SAG, Y - SAG)
T = 2 * np.pi * np.arange(120) / 120
EIGHT = Curve(np.stack([12 * np.sin(T), 8 * np.sin(2 * T), 0 * T], axis=1))
BENT = np.concatenate([line((-15, 6, 0), (-5, 0, 0), 11)[:-1], line((-5, 0, 0), (5, 0, 0), 11)])
U = np.array([[0.0, 0, 0], [3, 0, 0], [2.48, 2.95, 0], [-0.34, 1.93, 0]])
TWICE = np.stack([np.linspace(0, 20, 61), np.sin(np.linspace(0, 7, 61)), np.cos(np.linspace(0, 5, 61))], axis=1)


def separated(curve, radius, **options):
    """The result, all of whose motions the independent check accepts, and which is a rope of the share that is told."""
    task, iterates = Task.of(curve), []
    result = separate(curve, radius, callback=iterates.append, **options)
    check(iterates, task)
    share = result.outcome.share
    radii = np.broadcast_to(radius, len(result.curve.mesh.component_sizes))
    here = result.curve.vertices
    assert is_rope(result.curve.mesh, here, here, share * radii, task.obstacles)
    assert np.array_equal(result.last.radius, share * radii)
    moved = np.linalg.norm(here - task.curve.vertices, axis=1).max()
    assert result.outcome.moved == pytest.approx(moved)
    ends = task.curve.mesh.ends.ravel()
    assert options.get("free_ends") or np.array_equal(here[ends], task.curve.vertices[ends])
    return result


@pytest.mark.parametrize(
    ("curve", "radius", "crossings"),
    [
        (arcs(X, Y), 1.0, {(1, 0)}),
        (arcs(X, Y), (0.5, 1.5), {(1, 0)}),
        (arcs(X, Y, line((-8, -8, 0), (8, 8, 0))), 1.0, {(1, 0), (2, 0), (2, 1)}),
        (arcs(line((-15, 0, 0), (15, 0, 0), 31), BENT), 0.5, {(1, 0)}),
        (EIGHT, 1.0, {(0, 0)}),
        (Curve.from_components([ring(), ring()]), 1.0, {(1, 0)}),
        (LINKED, 3.0, set()),
        (Curve.from_components([ring(), ring(centre=(0, 0, 9))]), 1.0, set()),
    ],
    ids=["two", "two radii", "three through a point", "along a stretch", "itself", "twice", "linked", "nothing to do"],
)
def test_ropes_keep_clear(curve, radius, crossings):
    result = separated(curve, radius)
    assert result.status is Status.CONVERGED
    assert {(each.over, each.under) for each in result.outcome.crossings} == crossings
    parts = [*result.curve.components]
    if len(parts) > 1:
        assert least_distance(parts) >= 2.0 * np.min(radius)


@pytest.mark.parametrize(("over", "sign"), [("z", 1.0), ("-z", -1.0), (None, 1.0)])
def test_the_later_one_goes_over_as_asked(over, sign):
    lower, upper = separated(arcs(X, Y), 1.0, over=over).curve.components
    assert sign * (upper[10, 2] - lower[10, 2]) >= 2.0


def test_strands_that_are_apart_stay_on_their_sides():
    """The motion from the given curve on is proved, though they nearly touch."""
    near = arcs(X, Y - np.array([0, 0, 1e-6]))
    result = separated(near, 1.0)
    assert not result.outcome.crossings
    assert result.curve.components[1][10, 2] < result.curve.components[0][10, 2]


def test_a_random_bundle():
    curve, _ = bundle(60)
    result = separated(curve, 1.0)
    assert result.status is Status.CONVERGED
    assert least_distance([*result.curve.components]) >= 2.0
    # no more than neighbours in the way ask for, and straight strands get hardly longer
    assert result.outcome.moved < 2.0
    assert result.curve.length < 1.01 * curve.length


def test_few_vertices_are_enough_for_three_lines_through_a_point():
    ways = ((1.0, 0.0), (0.5, 0.75**0.5), (-0.5, 0.75**0.5))
    lines = arcs(*(line((-20 * x, -20 * y, 0), (20 * x, 20 * y, 0), 3) for x, y in ways))
    assert separate(lines, 1.0).status is Status.CONVERGED


def test_long_edges_are_cut_and_the_given_vertices_kept():
    task = Task(curve=arcs([[-12.0, 0, 0], [2, 0, 0], [12, 0, 0]], [[0.0, -12, 0], [0, 12, 0]]), pins=(1,))
    iterates = []
    result = separate(task, 1.0, callback=iterates.append)
    check(iterates, task)
    assert result.status is Status.CONVERGED
    assert [iterates[0].curve.vertices[k].tolist() for k in result.last.pins] == task.curve.vertices.tolist()
    assert np.array_equal(result.curve.vertices[list(result.last.pins)], task.curve.vertices)
    assert iterates[0].curve.edge_lengths.max() <= 4.1
    thin = separate(task, 1e-4)
    assert thin.status is Status.CONVERGED
    assert len(thin.curve) < 5000
    short = separate(arcs([[0.0, 0, 0], [3, 0, 0]], [[0.0, 1, 0], [3, 1, 0]]), 1.0)
    assert "room for 50 %" in short.message


def test_obstacles_are_respected():
    free = separated(arcs(X, Y), 1.0)
    between = separated(Task(curve=arcs(X, Y), obstacles=(WALL, POST)), 1.0)
    for each in (free, between):
        assert each.status is Status.CONVERGED
    assert free.curve.vertices[:, 2].max() < 1.6  # below the wall, though not by a radius
    assert between.curve.vertices[:, 2].max() < 0.6 + 1e-9
    assert np.hypot(*(between.curve.vertices[:, :2] - 0.9).T).min() >= 1.0


def test_lengths_are_kept():
    result = separated(SLACK, 1.0, lengths="keep")
    assert result.status is Status.CONVERGED
    assert np.abs(result.curve.edge_lengths / SLACK.edge_lengths - 1.0).max() <= 1e-3
    free = separated(arcs(X, Y), 1.0)
    assert free.curve.edge_lengths.max() > 1.001 * free.task.curve.edge_lengths.max()


def test_free_ends_move_with_their_strand():
    hair = Task(curve=arcs(X, Y), pins=(0, 21))
    result = separated(hair, 1.0, free_ends=True)
    assert result.status is Status.CONVERGED
    assert np.array_equal(result.curve.vertices[[0, 21]], hair.curve.vertices[[0, 21]])
    assert (result.curve.vertices[[20, 41]] != hair.curve.vertices[[20, 41]]).any()
    tangents = separated(Task(curve=arcs(X, Y), pins=(0, 21), pin_tangents=True), 1.0)
    assert np.array_equal(tangents.curve.vertices[[1, 22]], hair.curve.vertices[[1, 22]])


@pytest.mark.parametrize(
    ("curve", "radius", "options", "said"),
    [
        (arcs(X, X + np.array([0, 1.0, 0])), 1.0, {}, "room for 50 % of the radius only"),
        (Task(curve=arcs([[0.0, 0, 0], [2, 0, 0], [1, 1.5, 0]]), pins=(1,)), 1.0, {}, "at a corner of component 1"),
        (Task(curve=arcs(X), obstacles=(STICK,)), 1.0, {}, "between component 1 and obstacle stick"),
        (arcs(U), 1.0, {}, "between parts of component 1"),
        (LINKED, 3.0, {"lengths": "keep"}, "room for 8"),
        (NEARLY_TAUT, 1.0, {"lengths": "keep"}, "lengths cannot be"),
    ],
    ids=["pins too near", "corner", "pin at an obstacle", "coarse", "lengths too short", "nearly taut"],
)  # fmt: skip
def test_where_there_is_no_room_the_best_is_kept_and_the_place_told(curve, radius, options, said):
    result = separated(curve, radius, **options)
    assert result.status is Status.STALLED
    assert said in result.message
    assert result.outcome.place.vertices


@pytest.mark.parametrize(
    ("curve", "options", "said"),
    [
        (arcs(TWICE, TWICE), {}, "component 1 and component 2 are both held at (0, 0, 1); move one of them"),
        (arcs(X, Y), {"lengths": "keep"}, "component 1 and component 2 are both held at (0, 0, 0) by the lengths"),
        (arcs(X[::20], Y[::20]), {"lengths": "keep"}, "are both held at (0, 0, 0) by the lengths"),
        (arcs(X[::20] + 0.3, Y[::20] + np.array([0.4, 0, 0.3])), {"lengths": "keep"}, "led apart near (0.399609, 0.3"),
        (Curve(np.concatenate([ring(), ring()])), {}, "strands cannot be led apart near (8, 0, 0); move them there"),
        (arcs([[0.0, 0, 0], [2, 0, 0], [1, 0, 0], [1, 1, 0]]), {}, "doubles back at vertex 2"),
        (arcs([[0.0, 0, 0], [2, 0, 0], [2, 0, 0], [1, 1, 0]]), {}, "are the same point"),
        (Curve(ring()[:, :2]), {}, "separated in space"),
        (Task(curve=arcs(Y), obstacles=(GATE,)), {}, "pierces"),
        (arcs(X, Y), {"radius": (1.0, 2.0, 3.0)}, "3 numbers for 2 components"),
        (arcs(X, Y), {"radius": -1.0}, "a number above 0"),
        (arcs(X, Y), {"radius": 1e-300}, "radius is 1e-300, but coordinates are up to 12; give 1.2e-05 to 1200"),
        (arcs(X, Y), {"radius": (1.0, 1e300)}, "radius is 1e+300"),
        (arcs(X, Y), {"radius": float("nan")}, "a number above 0"),
        (arcs(X, Y), {"over": "up"}, "choose one of x"),
        (arcs(X, Y), {"lengths": "kept"}, "did you mean keep"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused_in_a_sentence(curve, options, said):
    with pytest.raises(MobiusFlowError) as refusal:
        separate(curve, **{"radius": 0.5, **options})
    assert said in str(refusal.value)
    place = getattr(refusal.value, "place", None)
    assert place is None or all(k < len(Task.of(curve).curve) for k in place.vertices)


def tangle():
    """Two arcs that nearly touch each other, an obstacle, and themselves at a corner, and a random direction."""
    rng = np.random.default_rng(3)
    curve = arcs(X + 0.4 * rng.normal(size=X.shape), Y + 0.4 * rng.normal(size=Y.shape) + np.array([0, 0, 1.2]))
    return curve, rng.normal(size=curve.vertices.shape)


@pytest.mark.parametrize("obstacles", [(), (WALL, POST)])
def test_derivatives_of_contacts_and_their_barrier(obstacles):
    curve, direction = tangle()
    radius = np.array([1.0, 0.7])

    def near(t):
        moved = curve.with_vertices(curve.vertices + t * direction)
        return clearances(moved, radius, curve.edge_lengths, 1.5, obstacles)

    def value(t):
        return near(t).barrier(0.05, 1.4)[0].sum()

    here = near(0.0)
    assert (here.edges[:, 1] < 0).any() == bool(obstacles)
    assert (curve.mesh.next[here.edges[:, 0]] == here.edges[:, 1]).any()
    value_here, slope, curvature = here.barrier(0.05, 1.4)
    by_vertices = here.sum_first(slope, len(curve))
    assert taylor_slope(value, [value_here.sum(), np.sum(by_vertices * direction)], 1e-3) == pytest.approx(2.0, abs=0.1)
    x = here._replace(value=here.value + 0.02)
    change = (x.barrier(0.05, 1.4)[1] - slope)[here.value < 1.3]
    assert (curvature >= 0.0).all()
    smaller = here._replace(value=here.value + 1e-7).barrier(0.05, 1.4)[1]
    assert np.allclose((smaller - slope) / 1e-7, curvature, rtol=1e-4, atol=1e-4 * curvature.max())
    assert (change >= 0.0).all()
    rows = np.zeros((len(slope), curve.vertices.size))
    for k, vertices in enumerate(here.vertices):
        for vertex, first in zip(vertices, here.first[k], strict=True):
            rows[k, 3 * vertex : 3 * vertex + 3] += first
    assert np.allclose(here.sum_squares(curvature, len(curve)).toarray(), rows.T @ (curvature[:, None] * rows))


def test_newton_steps_lower_what_is_minimised():
    """The gradient with kept lengths, by the decrease that a step promises."""
    held = np.zeros(len(SLACK), dtype=bool)
    held[SLACK.mesh.ends.ravel()] = True
    start = SLACK.with_vertices(SLACK.vertices + np.array([0.0, 0, 0.05]) * (SLACK.mesh.component == 1)[:, None])
    start = start.with_vertices(np.where(held[:, None], SLACK.vertices, start.vertices))
    ropes = Ropes(SLACK, np.ones(2), held, (), True)
    ropes.thicken(start, 0.5 * ropes.room(start))
    before = ropes.value(start, ropes.near(start, 1.2)[0], ropes.share, 0.16)
    end, size, decrement = ropes.step(start)
    after = ropes.value(end, ropes.near(end, 1.2)[0], ropes.share, 0.16)
    assert 0.0 < size <= 1.0
    assert before - after > 1e-4 * size * decrement > 0.0


def test_the_quadratic_form_is_that_of_the_integrals():
    """∫ (a u²/R² + T u'² + b R² u''²)/R of a sine on a fine mesh with unequal edges, and radius 2."""
    s = np.linspace(0.0, 1.0, 801) ** 1.2
    curve, radius = arcs(np.stack([20.0 * s, 0 * s, 0 * s], axis=1)), 2.0
    u, k = np.sin(np.pi * s), np.pi / 20.0
    exact = 10.0 * (1e-3 / radius**3 + 0.02 * k**2 / radius + 0.3 * radius * k**4)
    assert u @ (stiffness(curve, np.array([radius])) @ u) == pytest.approx(exact, rel=1e-3)


def test_a_barrier_that_has_outgrown_all_else_gives_no_step(monkeypatch):
    def singular(*_, **__):
        raise np.linalg.LinAlgError("matrix is singular")

    monkeypatch.setitem(Ropes.step.__globals__, "factorised", singular)
    assert separate(arcs(X, Y), 1.0).status is Status.STALLED


def test_places_of_crossings_are_free_of_rounding():
    circle = ring(1.0, 24)
    result = separate(Curve.from_components([circle, circle]), 0.1)
    (crossing,) = result.outcome.crossings
    assert all(x == 0.0 or abs(x) > 1e-12 for x in crossing.place)


@pytest.mark.parametrize("seconds", [-1.0, 0.0, np.nan])
def test_what_is_no_time(seconds):
    with pytest.raises(MobiusFlowError, match="time_limit"):
        SeparateOptions(radius=1.0, time_limit=seconds)
