"""A ball that proves a curve composite: found where there is one, never where there is none."""

from functools import partial

import numpy as np
import pytest
from families import family
from mobius_flow.core import Curve, RelaxOptions, Status, minimize
from mobius_flow.core.driver.moves.links import UNTESTED
from mobius_flow.core.knots import knot, scramble
from mobius_flow.core.knots.composite import _separating, is_searchable, knotted_ball
from scipy.optimize import linprog
from shapes import chain_of_rings, regular_polygon

COMPOSITES = ["3_1#3_1", "3_1#m3_1", "3_1#4_1", "4_1#5_2", "3_1#3_1#3_1", "L2a1#L2a1", "3_1#L2a1"]
PRIMES = ["0_1", "3_1", "4_1", "7_7", "8_19", "9_46", "10_132", "L2a1", "L6a4", "T(2,4)"]


def closed_chain(rings):
    """Round rings, each through the next one and the last through the first."""
    t = 2 * np.pi * np.arange(20) / 20
    components = []
    for angle in 2 * np.pi * np.arange(rings) / rings:
        outward, along = np.array([[np.cos(angle), np.sin(angle), 0.0], [-np.sin(angle), np.cos(angle), 0.0]])
        across = [outward, np.array([0.0, 0.0, 1.0])][len(components) % 2]
        components.append(0.23 * rings * outward + np.outer(np.cos(t), along) + np.outer(np.sin(t), across))
    return Curve.from_components(components)


HAVE_NONE = {
    "a square": lambda: Curve(np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])),
    **{name: partial(knot, name) for name in PRIMES},
    "a tangled circle": lambda: scramble(knot("0_1"), seed=3, moves=300),
    "a tangled 4_1": lambda: scramble(knot("4_1"), seed=3, moves=300),
    "a closed chain": lambda: closed_chain(6),
}


@pytest.mark.parametrize("name", family(HAVE_NONE, every=3))
def test_primes_have_none(name):
    assert knotted_ball(HAVE_NONE[name]()) is None


@pytest.mark.parametrize("name", COMPOSITES)
def test_composites_have_one(name):
    curve = knot(name)
    ball = knotted_ball(curve)
    assert ball is not None
    s = np.linspace(0.0, 1.0, 50)[:-1, None, None]
    start = curve.vertices[curve.mesh.tails]
    inside = np.linalg.norm(start + s * curve.edge_vectors - ball.center, axis=2) < ball.radius
    crossings = 0
    for part in curve.mesh.slices:
        along = inside[:, part].T.ravel()
        crossings += np.count_nonzero(along != np.roll(along, 1))
    assert crossings == 2
    moved = knotted_ball(curve.with_vertices(1e-3 * curve.vertices + [5.0, 6.0, 7.0]))
    np.testing.assert_allclose(moved.center, 1e-3 * ball.center + [5.0, 6.0, 7.0], rtol=1e-4)
    assert moved.radius == pytest.approx(1e-3 * ball.radius, rel=1e-3)


@pytest.mark.parametrize("name", ["3_1", "8_19", "3_1#4_1"])
def test_balls_are_found_where_a_linear_program_finds_them(name):
    """And there alone: for arcs of all lengths, most of which lie in none, and every ball has the arc inside."""
    x = knot(name).vertices
    x = (x - x.mean(axis=0)) / np.ptp(x)
    along = np.arange(len(x))
    inside = [(along - first) % len(x) < size for size in range(5, len(x) // 2, 7) for first in along[::9]]
    sides = np.where(inside, -1.0, 1.0)
    found = {side.tobytes() for side in sides if separable(x, side)}
    balls = list(_separating(x, sides))
    assert 0 < len(found) < len(sides)
    parts = [np.where(ball.contains(x), -1.0, 1.0) for ball in balls]
    assert len(parts) == len(found)
    assert all(part.tobytes() in found or (-part).tobytes() in found for part in parts)  # what is outside is a part too


def separable(x, side):
    rows = side[:, None] * np.column_stack([x, (x**2).sum(axis=1), np.ones(len(x))])
    bounds = [(-1.0, 1.0)] * 5 + [(0.0, 1.0)]
    solved = linprog([0.0] * 5 + [-1.0], np.column_stack([-rows, np.ones(len(x))]), np.zeros(len(x)), bounds=bounds)
    return solved.x[5] > 1e-6


def test_what_would_take_too_long_is_not_searched():
    """Rings that are not linked may lie in any way."""
    ring = regular_polygon(12).vertices
    for rings, searched in ((4, True), (8, False), (500, False)):
        curve = Curve.from_components([ring + np.array([0.0, 0.0, 0.1 * k]) for k in range(rings)])
        assert is_searchable(curve) == searched
    assert knotted_ball(curve) is None


def test_what_was_not_searched_is_said(monkeypatch):
    monkeypatch.setattr("mobius_flow.core.knots.composite.TRIALS", 1)
    result = minimize(chain_of_rings(3, (20,)), RelaxOptions(mesh="fixed", vertices=60, tolerance=3e-3))
    assert result.status is Status.CONVERGED
    assert f"; {UNTESTED}" in result.message


@pytest.mark.parametrize(
    ("make", "vertices"),
    [
        (partial(chain_of_rings, 5, (20,)), 100),
        (partial(knot, "granny"), 100),
        pytest.param(partial(knot, "L2a1#L2a1"), 80, marks=pytest.mark.slow),
    ],
    ids=["chain", "granny", "rings"],
)
def test_relaxing_a_composite_is_no_convergence_and_has_no_index(make, vertices):
    options = RelaxOptions(mesh="fixed", vertices=vertices, tolerance=3e-3, stability=True)
    result = minimize(make(), options)
    assert result.status is Status.STALLED
    for said in ("composite", "pull tight", "no shape of least energy"):
        assert said in result.message
    assert result.outcome.negative_eigenvalues is None
    assert result.certified
