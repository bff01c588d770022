"""What the flow does to links: unlinked parts are held once far apart, and composite and open knots are told of."""

import logging
import tracemalloc
from dataclasses import replace

import numpy as np
import pytest
from mobius_flow.core import Curve, Mesh, Obstacle, RelaxOptions, Status, minimize
from mobius_flow.core.curve import refine
from mobius_flow.core.driver.moves import links
from mobius_flow.core.driver.moves.links import DIRECTIONS, open_knots, separate_parts
from mobius_flow.core.driver.prepare import start_problem
from mobius_flow.core.knots import knot, overhand
from mobius_flow.core.knots.composite import Ball
from mobius_flow.core.solve.constraints import Barycenters, Constraints
from solids import box, plate, rod
from tasks import wanted

SLOW = [pytest.param(method, marks=pytest.mark.slow) for method in ("cg", "flow-moebius", "trust-region")]


def ring(center, radius=1.0, size=12):
    t = 2 * np.pi * np.arange(size) / size
    return np.array(center) + radius * np.column_stack([np.cos(t), np.sin(t), 0 * t])


def rings(*xs, radius=1.0, size=12):
    return Curve.from_components([ring([x, 0, 0], radius, size) for x in xs])


def two_rings(distance):
    shift = np.array([distance, 0.0, 0.3])
    return Curve.from_components([ring([0, 0, 0], size=30), ring([0, 0, 0], size=30) + shift])


# a chain of small rings through a large one: every two small balls are far apart, the balls of chains are not
THROUGH = [ring([0, 0, 0], 5.0, 40), *(ring([5.0 + x, 0.0, 0.0], 0.1) for x in (-4.0, 0.0, 4.0))]
POST = Obstacle([[0.0, 0.0, 5.0], [0.0, 0.0, 6.0]], [[0, 1]])


@pytest.mark.parametrize(
    ("curve", "obstacles", "parts"),
    [
        (rings(0, 4), (), (0, 1)),
        (rings(0, 2.9), (), (0, 0)),
        (rings(0, 9, 2.5, 11), (), (0, 1, 0, 1)),
        (knot("3_1"), (), (0,)),
        (knot("L2a1"), (), (0, 0)),
        (Curve.from_components(THROUGH), (), (0, 0, 0, 0)),
        (rings(*(4.0 * k for k in range(60))), (), (0,) * 60),  # very many parts are one
        (two_rings(6.0), (box(-9.0, 9.0),), (0, 0)),  # between walls nothing drifts away
        (two_rings(90.0), (POST,), (0, 1)),
        (two_rings(6.0), (rod(1e4, 0.0),), (0, 1)),
    ],
)
def test_far_parts_are_told_apart(curve, obstacles, parts):
    assert separate_parts(curve, obstacles) == parts


def test_parts_of_thousands_of_components_without_a_matrix_of_all_pairs():
    count = 20_000  # a matrix of all pairs would have 400,000,000 entries
    chain = [ring([1.5 * k, 0.0, 0.0], size=3) for k in range(count)]
    far = [ring([1.5 * k, 1e6 * (k + 1), 0.0], size=3) for k in range(10)]
    parts = separate_parts(Curve.from_components([*chain, *far]))
    assert parts == (0,) * count + tuple(range(1, 11))


@pytest.fixture
def parted():
    rng = np.random.default_rng(4)
    curve = rings(0, 5, 10)
    curve = curve.with_vertices(curve.vertices + 0.1 * rng.normal(size=curve.vertices.shape))
    return curve, Constraints(1.1 * curve.edge_lengths, Barycenters.of(curve, parts=(0, 1, 1)))


def test_barycenters_of_many_parts_take_no_more_memory_than_one():
    curve = rings(*(4.0 * k for k in range(50)), size=400)
    tracemalloc.start()
    derivative = Constraints(curve.edge_lengths, Barycenters.of(curve, parts=tuple(range(50)))).derivative(curve)
    derivative.apply_transpose(derivative.apply(curve.vertices))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert derivative.count == len(curve) + 150
    assert peak < 1000 * len(curve)  # one row has 24 bytes a vertex


@pytest.mark.parametrize("method", ["lbfgs", *SLOW])
def test_unlinked_circles_come_to_rest(method):
    """They used to drift apart until the iterations were used up."""
    curve = Curve.from_components([ring([0, 0, 0], 1.0, 40), ring([0.2, 0, 0.1], 1.0, 40)])
    result = minimize(curve, RelaxOptions(method=method, vertices=80))
    assert result.status is Status.CONVERGED
    assert "unlinked" in result.message
    assert float(result.message.split()[-1]) == pytest.approx(8, rel=1e-2)
    assert result.certified
    assert np.abs(result.curve.vertices).max() < 20
    for component in result.curve.components:
        edges = np.linalg.norm(component - np.roll(component, 1, axis=0), axis=1)
        radius = np.linalg.norm(component - component.mean(axis=0), axis=1)
        assert radius.std() < 1e-2 * radius.mean()
        assert edges.std() < 1e-9


def test_held_parts_stay_held_on_another_mesh():
    options = RelaxOptions(vertices=60)
    curve, fine = (refine(rings(0, 5), vertices) for vertices in (30, 60))
    problem = start_problem(curve, options)
    held = Barycenters.of(problem.at_curve(curve).curve, parts=(0, 1))
    parted = replace(problem.constraints, barycenters=held)
    problem = replace(problem, constraints=parted)
    point = problem.on(fine)
    assert point.problem.constraints.barycenters.parts == (0, 1)
    np.testing.assert_allclose(point.residual[len(fine) :], np.zeros(6), atol=1e-12)


@pytest.mark.parametrize(
    ("curve", "options", "held"),
    [
        (knot("L2a1"), {"vertices": 120}, False),  # linked
        (two_rings(5.0), {"avoid": (box(-9.0, 9.0),), "vertices": 60, "tolerance": 0.1}, False),
        (two_rings(9.0), {"pins": (0, 30), "vertices": 60, "max_iterations": 300}, False),
        (two_rings(9.0), {"pins": (0,), "vertices": 60, "max_iterations": 300}, True),
    ],
    ids=["linked", "in a box", "pinned", "one pinned"],
)
def test_parts_are_said_to_be_held_where_they_are(curve, options, held):
    result = minimize(*wanted(curve, **options))
    assert result.status is Status.CONVERGED
    assert ("unlinked parts" in result.message) is held


# -- composite -------------------------------------------------------------------------------------------------------


def test_balls_and_obstacles():
    ball = Ball(np.array([0.0, 0.0, 2.0]), 1.0)
    inside = Obstacle([[0, 0, 2], [0, 0, 3]], [[0, 1]])
    walls = [plate(0.99), plate(1.01), rod(1.01, 0.0), inside, box(-9.0, 9.0)]  # a surface: the ball is inside
    assert [ball.is_clear_of(wall) for wall in walls] == [True, False, True, False, True]


@pytest.mark.parametrize(("post", "composite"), [((9.0, 9.0), True), ((0.0, 0.0), False)])
def test_a_knotted_part_around_a_post_does_not_shrink(post, composite, monkeypatch):
    monkeypatch.setattr(links, "knotted_ball", lambda curve: Ball(np.zeros(3), 1.0))
    curve = knot("3_1#3_1", 60)  # so few that its strands are not resolved
    size = float(np.abs(curve.vertices).max())
    far = curve.with_vertices(curve.vertices / size * 3.0 + [20.0, 0.0, 0.0])
    result = minimize(*wanted(far, vertices=None, mesh="fixed", tolerance=0.2, avoid=(rod(*post),)))
    assert ("is composite" in result.message) == composite


# -- open knots ------------------------------------------------------------------------------------------------------

LOST = "component 1, which is open, was 3_1 if its ends are joined far away, and is not any more"


def test_types_of_open_components():
    arc, closed = overhand(60), knot("4_1", 60)
    both = Curve(np.vstack([closed.vertices, arc.vertices + 100.0]), Mesh((60, 60), (True, False)))
    assert open_knots(both) == {1: "3_1"}
    assert open_knots(arc.with_vertices(arc.vertices * [1.0, 1.0, -1.0])) == {0: "m3_1"}
    for unknotted in (closed, Curve([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 1]], Mesh((4,), (False,)))):
        assert open_knots(unknotted) == {}
    for direction in DIRECTIONS:  # towards a point where ends are joined
        assert open_knots(Curve(np.linspace(0.0, 4.0, 9)[:, None] * direction, Mesh((9,), (False,)))) == {}


@pytest.mark.parametrize(("pins", "told"), [((), True), ((0,), True), ((0, 59), False)])
def test_a_knot_that_may_be_lost_is_told_before_and_after(pins, told, caplog):
    with caplog.at_level(logging.WARNING):
        result = minimize(*wanted(overhand(60), pins=pins, vertices=60, max_iterations=5 if pins else 2000))
    assert ("component 1 is open and knotted (3_1, if its ends are joined far away)" in caplog.text) is told
    assert (LOST in result.outcome.clauses) is (pins == ())
