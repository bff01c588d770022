"""A ball that proves a curve composite: found where there is one, never where there is none."""

import numpy as np
import pytest
from mobius_flow.core import Curve, RelaxOptions, Status, minimize
from mobius_flow.core.knots import knot, scramble
from mobius_flow.core.knots.composite import knotted_ball

COMPOSITES = ["3_1#3_1", "3_1#m3_1", "3_1#4_1", "4_1#5_2", "3_1#3_1#3_1", "L2a1#L2a1", "3_1#L2a1"]
PRIMES = ["0_1", "3_1", "4_1", "7_7", "8_19", "9_46", "10_132", "L2a1", "L6a4", "T(2,4)"]


@pytest.mark.parametrize("name", COMPOSITES)
def test_composites_have_one(name):
    """And its sphere meets the curve twice, counted on much finer points."""
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


@pytest.mark.parametrize("name", PRIMES)
def test_primes_have_none(name):
    assert knotted_ball(knot(name)) is None


def test_tangled_curves_have_none():
    assert knotted_ball(scramble(knot("0_1"), seed=3)) is None
    assert knotted_ball(scramble(knot("4_1"), seed=3)) is None


def test_it_moves_with_the_curve():
    curve = knot("3_1#4_1")
    ball = knotted_ball(curve)
    moved = knotted_ball(curve.with_vertices(1e-3 * curve.vertices + [5.0, 6.0, 7.0]))
    np.testing.assert_allclose(moved.center, 1e-3 * ball.center + [5.0, 6.0, 7.0])
    assert moved.radius == pytest.approx(1e-3 * ball.radius)


def test_flat_curves_and_many_components_have_none():
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    assert knotted_ball(Curve(square)) is None
    rings = [np.column_stack([square, np.full(4, float(k))]) for k in range(5)]
    assert knotted_ball(Curve.from_components(rings)) is None


@pytest.mark.parametrize(("name", "vertices"), [("granny", 100), ("L2a1#L2a1", 80)])
def test_relaxing_a_composite_is_no_convergence(name, vertices):
    result = minimize(knot(name), RelaxOptions(vertices=vertices, tolerance=3e-3))
    assert result.status is Status.STALLED
    assert "pull tight" in result.message
    assert "composite" in result.message
    assert result.certified
