"""Integrals along edges however near they are to a triangle, against mpmath; and how much work they take."""

import numpy as np
import pytest
from energy_references import inverse_square_integral
from families import crossed
from mobius_flow.core import Curve
from mobius_flow.core.curve.obstacle import Obstacle
from mobius_flow.core.energies.repulsion.repulsion import Schedule
from repulsion_references import edge_integral, repulsion

TRIANGLE = np.array([[0, 0, 0], [1, 0, 0], [0.2, 0.9, 0]])

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


def curve_of(start: list[float], end: list[float]) -> Curve:
    """A curve with that edge."""
    return Curve([start, end, [9.0, 9.0, 9.0]])


def integrated(obstacle: Obstacle, curve: Curve) -> tuple[float, Schedule]:
    """∫ Φ ds over the first edge, and by what panels."""
    term = repulsion(obstacle).frozen_at(curve)
    return float(2 * np.pi * curve.edge_lengths[0] / term.clearance(curve)[0]), term.schedule


@pytest.mark.parametrize(("shape", "gap"), crossed(SHAPES, [1e-1, 1e-3, 1e-6]))
def test_triangles(shape: str, gap: float) -> None:
    start, end, breaks = SHAPES[shape](gap)
    found, _ = integrated(Obstacle(TRIANGLE, [[0, 1, 2]]), curve_of(start, end))
    reference = edge_integral(TRIANGLE, np.array(start), np.array(end), [*breaks, 0.0, 1.0])
    assert found == pytest.approx(reference, rel=1e-8)


@pytest.mark.parametrize(("shape", "gap"), crossed(SHAPES, [1e-1, 1e-3, 1e-6]))
def test_segments(shape: str, gap: float) -> None:
    start, end, _ = SHAPES[shape](gap)
    segment = np.array([[0.0, 0, 0], [1.0, 0, 0]])
    found, _ = integrated(Obstacle(segment, [[0, 1]]), curve_of(start, end))
    reference = 2 * inverse_square_integral(start, end, *segment.tolist())
    length = np.linalg.norm(np.subtract(start, end))
    assert found == pytest.approx(float(reference * length), rel=1e-8)


def test_an_edge_may_be_in_the_middle_of_an_obstacle() -> None:
    box = np.array([[2.0, 2, 2], [2, -2, -2], [-2, 2, -2], [-2, -2, 2]])
    obstacle = Obstacle(box, [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]])
    curve = Curve([[-0.1, 0, 0], [0.1, 0, 0], [0, 0.3, 0.1]])
    assert repulsion(obstacle, 0.4).value(curve) == pytest.approx(repulsion(obstacle).value(curve), rel=1e-3)
