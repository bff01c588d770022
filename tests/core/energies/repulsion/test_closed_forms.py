"""Potentials of triangles and segments in closed form, and their integrals along edges, against quadrature."""

import numpy as np
import pytest
from energy_references import inverse_square_integral
from families import crossed
from mobius_flow.core import Curve
from mobius_flow.core.curve.obstacle import Obstacle
from mobius_flow.core.energies.edge_pairs import change, stepped
from mobius_flow.core.energies.repulsion.simplices import Simplices
from repulsion_references import edge_integral, potential_by_quadrature, repulsion
from taylor import taylor_slope

TRIANGLE = np.array([[0.1, 0.2, -0.3], [1.3, 0.0, 0.4], [0.2, 0.9, 0.5]])
SEGMENT = TRIANGLE[:2]
NORMAL = np.cross(TRIANGLE[1] - TRIANGLE[0], TRIANGLE[2] - TRIANGLE[0])
A, B, C = TRIANGLE

POINTS = {
    "anywhere": np.array([0.7, -0.9, 1.1]),
    "far": np.array([30.0, -20.0, 10.0]),
    "above": (A + B + C) / 3 + 0.4 * NORMAL,
    "above a side": 0.4 * A + 0.6 * B + 0.4 * NORMAL,
    "above a corner": A + 0.4 * NORMAL,
    "in the plane": A + 1.5 * (B - A) + 0.5 * (C - A),
    "in the plane, beside a side": 0.4 * A + 0.6 * B - 0.4 * (C - A),
    "on the line of a side": 2.5 * A - 1.5 * B,
    "nearly in the plane": A + 1.5 * (B - A) + 0.5 * (C - A) + 1e-9 * NORMAL,
    "hardly off the plane": A + 1.5 * (B - A) + 0.5 * (C - A) + 3e-3 * NORMAL,
}
POINT = pytest.mark.parametrize("x", POINTS.values(), ids=POINTS)
CORNERS = pytest.mark.parametrize("corners", [TRIANGLE, SEGMENT], ids=["triangle", "segment"])
ONLY = np.array([0])


def simplex(corners):
    return Simplices(np.ascontiguousarray(corners[:, :, None]))


def potential(corners, x):
    value, gradient = simplex(corners).potential(ONLY, x[:, None, None])
    return value[0, 0], gradient[:, 0, 0]


@CORNERS
@POINT
def test_value_and_derivatives(corners, x):
    v = np.random.default_rng(5).normal(size=3)
    value, gradient = potential(corners, x)
    assert value == pytest.approx(potential_by_quadrature(corners, x), rel=1e-9)
    changed = potential(corners, stepped(x, v))
    assert change(changed[0]) == pytest.approx(gradient @ v, rel=1e-9)
    for k, terms in enumerate(([value, gradient @ v], [gradient, change(changed[1])])):
        slope = taylor_slope(lambda t, k=k: potential(corners, x + t * v)[k], terms, 0.03 * np.linalg.norm(x - A))
        assert slope == pytest.approx(2, abs=0.05)


def test_analytic_discs_end_at_singularities():
    """On the circle around x of the radius that is told, Φ has a singularity where it can be computed."""
    triangle, tau = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]]), np.array([0.6, 0.0, 0.8])
    reach = simplex(triangle).reach
    for x, expected in (
        ([0.3, 0.3, 0.1], 0.1 / 0.8),  # the plane
        ([0.5, -0.1, 0.0], 0.1 / 0.8),  # a side
        ([-0.3, -0.4, 0.0], 0.5),  # a corner
    ):
        assert reach(ONLY, np.array(x)[:, None], tau[:, None])[0] == pytest.approx(expected)
    along = np.array([[1.0], [0.0], [0.0]])
    assert reach(ONLY, np.array([[0.3], [1e-9], [1e-9]]), along)[0] == pytest.approx(0.3)


FLAT = np.array([[0, 0, 0], [1, 0, 0], [0.2, 0.9, 0]])

# ends of an edge at a gap g from the triangle, and the parameters of its nearly singular points
SHAPES = {
    "above": lambda g: ([0.3, 0.1, g], [0.4, 0.5, g], []),
    "end above": lambda g: ([0.3, 0.3, g], [0.5, 0.2, 1], [0]),
    "end above, slanting": lambda g: ([0.3, 0.3, g], [0.4, 0.33, 0.01], [0]),
    "across a side": lambda g: ([0.5, -0.5, g], [0.5, 0.5, g], [0.5]),
    "past a side": lambda g: ([0.2, -g, -0.4], [0.7, -g, 0.3], [4 / 7]),
    "along a side": lambda g: ([-0.3, -g, 1e-3 * g], [1.2, -g, 1e-3 * g], [0.2, 1.3 / 1.5]),
    "along a side, above": lambda g: ([0.1, 0, g], [0.8, 0, g], []),
    "tip at a corner": lambda g: ([-1, -1, 0.1], [-g, -g, g], [1]),
    "over a corner": lambda g: ([-0.5, -0.5, g], [0.5, 0.5, g], [0.5]),
    "slightly tilted": lambda g: ([0.3, 0.1, g], [0.4, 0.5, 2 * g], []),
}


def curve_of(start, end):
    """A curve with that edge."""
    return Curve([start, end, [9.0, 9.0, 9.0]])


def integrated(obstacle, curve):
    """∫ Φ ds over the first edge, and by what panels."""
    term = repulsion(obstacle).frozen_at(curve)
    return float(2 * np.pi * curve.edge_lengths[0] / term.clearance(curve)[0]), term.schedule


@pytest.mark.parametrize(("shape", "gap"), crossed(SHAPES, [1e-1, 1e-3, 1e-6]))
def test_triangles(shape, gap):
    start, end, breaks = SHAPES[shape](gap)
    found, _ = integrated(Obstacle(FLAT, [[0, 1, 2]]), curve_of(start, end))
    reference = edge_integral(FLAT, np.array(start), np.array(end), [*breaks, 0.0, 1.0])
    assert found == pytest.approx(reference, rel=1e-8)


@pytest.mark.parametrize(("shape", "gap"), crossed(SHAPES, [1e-1, 1e-3, 1e-6]))
def test_segments(shape, gap):
    start, end, _ = SHAPES[shape](gap)
    segment = np.array([[0.0, 0, 0], [1.0, 0, 0]])
    found, _ = integrated(Obstacle(segment, [[0, 1]]), curve_of(start, end))
    reference = 2 * inverse_square_integral(start, end, *segment.tolist())
    length = np.linalg.norm(np.subtract(start, end))
    assert found == pytest.approx(float(reference * length), rel=1e-8)


def test_an_edge_may_be_in_the_middle_of_an_obstacle():
    box = np.array([[2.0, 2, 2], [2, -2, -2], [-2, 2, -2], [-2, -2, 2]])
    obstacle = Obstacle(box, [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]])
    curve = Curve([[-0.1, 0, 0], [0.1, 0, 0], [0, 0.3, 0.1]])
    assert repulsion(obstacle, 0.4).value(curve) == pytest.approx(repulsion(obstacle).value(curve), rel=1e-3)
