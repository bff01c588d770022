"""Thickness against values by hand and against brute force."""

import numpy as np
import pytest
from mobius_flow.core import Curve
from mobius_flow.core.collision.gap import squared_segment_distances
from mobius_flow.core.collision.thickness import bending_radii, thickness
from mobius_flow.core.curve.distances import arc_distance_of_pairs
from mobius_flow.core.knots import knot, rope, smooth_knot


def slow_thickness(curve: Curve) -> float:
    """The same over all pairs of edges."""
    n, bend = len(curve), bending_radii(curve).min()
    i, j = np.triu_indices(n, 2)
    heads = curve.mesh.heads
    kept = (heads[j] != i) & (heads[i] != j) & (arc_distance_of_pairs(curve, i, j) >= np.pi * bend)
    i, j = i[kept], j[kept]
    squares = squared_segment_distances(curve.vertices.T.copy(), np.stack([i, heads[i], j, heads[j]]))
    return float(min(bend, 0.5 * np.sqrt(squares.min(initial=np.inf))))


@pytest.mark.parametrize("count", [3, 4, 7, 200])
def test_regular_polygons_have_the_radius_of_their_inner_circle(count: int) -> None:
    angle = 2.0 * np.pi * np.arange(count) / count
    circle = Curve(5.0 * np.column_stack([np.cos(angle), np.sin(angle), 0.0 * angle]))
    assert thickness(circle) == pytest.approx(5.0 * np.cos(np.pi / count))
    assert np.allclose(bending_radii(circle), 5.0 * np.cos(np.pi / count))


def test_strands_side_by_side() -> None:
    curve = rope(2, 0.05, 120)
    assert thickness(curve) <= 0.025 + 1e-12
    hopf = knot("hopf", 200)
    assert thickness(hopf) == pytest.approx(slow_thickness(hopf))


@pytest.mark.parametrize("name", ["3_1", "8_19", "L6a4"])
def test_brute_force_and_scale(name: str) -> None:
    curve = smooth_knot(name, 150)
    assert thickness(curve) == pytest.approx(slow_thickness(curve), rel=1e-12)
    assert thickness(curve.with_vertices(1e6 * curve.vertices)) == pytest.approx(1e6 * thickness(curve), rel=1e-9)
