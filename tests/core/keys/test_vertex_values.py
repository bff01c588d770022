"""Distances to the nearest other strand."""

import numpy as np
import pytest
from mobius_flow.core import Curve
from mobius_flow.core.keys import colours
from mobius_flow.core.keys.colours import strand_distances
from shapes import hopf_link, regular_polygon, torus_trefoil


def rings(distance, n=200):
    """Two round rings of radius 1 on one axis."""
    ring = regular_polygon(n).vertices
    return Curve.from_components([ring, ring + np.array([0.0, 0.0, distance])])


def test_of_two_rings():
    np.testing.assert_allclose(strand_distances(rings(0.25)), 0.25, rtol=1e-12)


def test_edges_count_and_not_their_ends_only():
    near, far = regular_polygon(200), regular_polygon(20).vertices + np.array([0.0, 0.0, 0.1])
    curve = Curve.from_components([near.vertices, far])
    sagitta = 1 - np.cos(np.pi / 20)
    assert strand_distances(curve)[:200].max() <= np.hypot(0.1, sagitta) + 1e-12


def test_converges_on_a_smooth_knot():
    """The torus trefoil is symmetric under turns by 120°."""
    distances = [strand_distances(torus_trefoil(n))[0] for n in (300, 600, 1200)]
    assert abs(distances[2] - distances[1]) < 0.5 * abs(distances[1] - distances[0]) + 1e-6
    d = strand_distances(torus_trefoil(300))
    np.testing.assert_allclose(d, np.roll(d, 100), atol=1e-9)


def test_a_circle_has_no_other_strand():
    np.testing.assert_allclose(strand_distances(regular_polygon(60)), np.sqrt(8), rtol=1e-2)


@pytest.mark.parametrize("block", [1, 1000])
def test_blocks_do_not_matter(monkeypatch, block):
    curve = hopf_link(40)
    whole = strand_distances(curve)
    monkeypatch.setattr(colours, "_BLOCK", block)
    np.testing.assert_array_equal(strand_distances(curve), whole)


def test_of_two_segments():
    segment = np.linspace(-1, 1, 50)[:, None] * np.array([1.0, 0.0, 0.0])
    curve = Curve.from_components([segment, segment + np.array([0.0, 0.25, 0.0])], (False, False))
    np.testing.assert_allclose(strand_distances(curve), 0.25, rtol=1e-12)


def test_a_straight_arc_has_no_other_strand():
    segment = np.linspace(0, 1, 50)[:, None] * np.array([1.0, 2.0, 2.0])
    np.testing.assert_allclose(strand_distances(Curve.from_components([segment], (False,))), 3.0, rtol=1e-12)


def test_ends_that_nearly_meet_are_near():
    """A ring with a gap: its ends are on different strands."""
    angles = np.linspace(0.02, 2 * np.pi - 0.02, 300)
    ring = np.column_stack([np.cos(angles), np.sin(angles), 0 * angles])
    distances = strand_distances(Curve.from_components([ring], (False,)))
    np.testing.assert_allclose(distances[[0, -1]], 2 * np.sin(0.02), rtol=1e-9)


def test_the_two_sides_of_a_bend_are_one_strand():
    """Across a leaf of a clover the way along it is short, too; from side to side of an ellipse it is not."""
    t = 2.0 * np.pi * np.arange(200) / 200
    circle = np.stack([np.cos(t), np.sin(t), 0.0 * t], axis=1)
    clover = strand_distances(Curve((1.0 + 0.3 * np.cos(3.0 * t))[:, None] * circle))
    np.testing.assert_array_equal(clover, clover[0])
    ellipse = strand_distances(Curve(circle * [4.0, 1.0, 1.0]))
    assert ellipse.min() > 1.4
    assert ellipse[50] == pytest.approx(2.0, rel=1e-3)
