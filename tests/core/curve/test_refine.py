"""Refinement changes the mesh and not the curve; arcs closed far away have the knots that one sees."""

import numpy as np
import pytest
from mobius_flow.core import Curve, Mesh, OptionError
from mobius_flow.core.collision import check_embedded
from mobius_flow.core.curve.refine import Resolution, refine, subdivide
from mobius_flow.core.knots import knot_type
from mobius_flow.core.knots.closures import closed_far_away
from shapes import hopf_link, lattice_knot, regular_polygon


def contains(curve, refined):
    """Whether the refined vertices include the curve's, in order, and the others lie on its edges."""
    position = 0
    for k, vertex in enumerate(curve.vertices):
        matches = np.flatnonzero((refined.vertices == vertex).all(axis=1))
        if len(matches) != 1 or matches[0] < position:
            return False
        position = matches[0]
        head = curve.vertices[curve.mesh.heads[k]]
        if abs(np.linalg.norm(head - vertex) - curve.edge_lengths[k]) > 1e-12:
            return False
    return abs(refined.length - curve.length) < 1e-12 * curve.length


@pytest.mark.parametrize("count", [60, 61, 100, 333])
def test_count_asked_for(count):
    curve = hopf_link(30)
    refined = refine(curve, count)
    assert len(refined) == count
    assert len(refined.mesh.component_sizes) == 2
    assert contains(curve, refined)
    with pytest.raises(OptionError, match="vertices is 20, but the curve has 60 already"):
        refine(curve, 20)


def test_default_count_and_evenness():
    rectangle = Curve([[0, 0, 0], [3, 0, 0], [3, 1, 0], [0, 1, 0]])
    refined = refine(rectangle)
    assert Resolution.usual <= len(refined) <= 1.1 * Resolution.usual
    assert refined.edge_lengths.max() < 1.1 * refined.edge_lengths.min()
    assert contains(rectangle, refined)
    fine = regular_polygon(600)
    np.testing.assert_array_equal(refine(fine).vertices, fine.vertices)


def test_neighbours_become_nearer_than_strands():
    curve = Curve([[0, 0, 0], [10, 0, 0], [10, 0.2, 0], [0, 0.2, 0.0]])
    refined = refine(curve)
    along = refined.vertices[
        (refined.vertices[:, 1] == 0) & (refined.vertices[:, 0] > 1) & (refined.vertices[:, 0] < 9)
    ]
    assert np.diff(np.sort(along[:, 0])).max() < 0.2


def kite(degrees, cuts):
    """A plane quadrangle with one corner of the given angle, its sides cut into pieces, uneven ones if several."""
    half = np.deg2rad(degrees) / 2
    side = np.array([np.cos(half), np.sin(half), 0.0])
    steps = np.linspace(0, 1, cuts + 1)[1:, None] ** 1.5
    tail = np.array([[side[0] + np.sin(half), 0.0, 0.0]])
    return Curve(np.concatenate([np.zeros((1, 3)), steps * side, tail, (steps * side * [1, -1, 1])[::-1]]))


@pytest.mark.parametrize("cuts", [1, 7])
@pytest.mark.parametrize("degrees", [90, 61, 60, 59.9, 45, 20, 5, 1])
def test_a_sharp_corner_is_no_near_strand(degrees, cuts):
    """Its sides are as near to each other at every scale; only the tail's angle adds up with the number of pieces."""
    curve = kite(degrees, cuts)
    assert Resolution.usual <= len(refine(curve)) <= Resolution.usual + len(curve)


@pytest.mark.parametrize("gap", [0.02, 0.005])
@pytest.mark.parametrize("round_the_end", [False, True])
def test_strands_side_by_side_are_near_though_a_bend_joins_them(gap, round_the_end):
    """A hairpin, square or round: the way round its end does not make it a corner."""
    t = np.linspace(-np.pi / 2, np.pi / 2, 16) if round_the_end else np.array([-np.pi / 2, np.pi / 2])
    end = np.stack([1 + 0.5 * gap * np.cos(t), 0.5 * gap * np.sin(t)], axis=1)
    hairpin = Curve(np.concatenate([[[0.0, -0.5 * gap]], end, [[0.0, 0.5 * gap], [-1.0, 1.0], [-1.0, -1.0]]]))
    assert hairpin.length / Resolution.usual > gap
    refined = refine(hairpin)
    middle = (refined.vertices[:, 0] > 0.01) & (refined.vertices[:, 0] < 0.99)
    assert refined.edge_lengths[middle].max() <= 1.2 * gap


@pytest.mark.parametrize("name", ["3_1", "6_2", "L5a1"])
def test_lattice_polygons(name):
    curve = lattice_knot(name)
    refined = refine(curve)
    assert contains(curve, refined)
    assert refined.edge_lengths.max() <= 1.0


def test_subdivide_places_equal_parts():
    curve = regular_polygon(4)
    fine = subdivide(curve, np.array([1, 2, 3, 1]))
    np.testing.assert_allclose(fine.edge_lengths, np.sqrt(2) / np.array([1, 2, 2, 3, 3, 3, 1]))


@pytest.mark.parametrize("gap", [1e-3, 1e-6, 1e-12])
def test_narrow_gaps_cost_no_more_than_can_be_afforded(gap):
    curve = Curve([[0, 0, 0], [10, 0, 0], [10, gap, 0], [5, gap, 1], [0, gap, 0]])
    refined = refine(curve)
    assert len(refined) <= 1000
    assert contains(curve, refined)


def test_what_is_closed_stays_and_arcs_do_not_meet_far_away():
    rng = np.random.default_rng(21)
    parts = [rng.normal(size=(6, 3)) for _ in range(4)] + [5 + np.eye(3)]
    closed = closed_far_away(Curve.from_components(parts, [False] * 4 + [True]))
    check_embedded(closed)
    assert np.array_equal(closed.components[-1], parts[-1])
    for part, before in zip(closed.components, parts, strict=True):
        assert np.array_equal(part[: len(before)], before)


@pytest.mark.parametrize("bent", [0.0, 0.1])
def test_straight_arcs_have_ends_that_are_opposite(bent):
    arc = Curve([[-1.0, 0, 0], [0, bent, 0], [1, 0, 0]], Mesh((3,), (False,)))
    assert knot_type(closed_far_away(arc)).names == ("0_1",)
