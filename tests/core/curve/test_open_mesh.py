"""Connectivity of closed and open components together, against lists of edges made one by one."""

import pickle
from itertools import pairwise

import numpy as np
import pytest
from mobius_flow.core import Curve, CurveError, Mesh
from mobius_flow.core.curve import check_closed
from mobius_flow.core.curve.distances import arc_distance_of_pairs, arc_distance_of_vertices, points_along
from mobius_flow.core.curve.refine import refine
from shapes import half_circle, opened, torus_trefoil

SIZES, CLOSED = (5, 2, 3, 4, 6, 3), (True, False, False, True, False, True)
MESH = Mesh(SIZES, CLOSED)


def listed_edges():
    """Tail, head and component of each edge."""
    edges, first = [], 0
    for number, (size, closed) in enumerate(zip(SIZES, CLOSED, strict=True)):
        ring = [*range(first, first + size), *([first] if closed else [])]
        edges += [(tail, head, number) for tail, head in pairwise(ring)]
        first += size
    return edges


def test_edges():
    assert list(zip(MESH.tails, MESH.heads, MESH.edge_component, strict=True)) == listed_edges()
    assert (MESH.edges, MESH.size) == (20, 23)
    assert MESH.edge_counts.tolist() == [5, 1, 2, 4, 5, 3]
    assert MESH.ends.tolist() == [[5, 6], [7, 9], [14, 19]]
    assert Mesh.of_edges(MESH.edge_counts, CLOSED) == MESH == pickle.loads(pickle.dumps(MESH))
    assert Mesh((4, 5)) == Mesh((4, 5), (True, True)) != Mesh((4, 5), (True, False))
    assert (Mesh((4, 5)).all_closed, MESH.all_closed) == (True, False)


def test_neighbours_are_themselves_where_there_are_none():
    edges = listed_edges()
    for number, (tail, head, _) in enumerate(edges):
        after = [k for k, edge in enumerate(edges) if edge[0] == head]
        before = [k for k, edge in enumerate(edges) if edge[1] == tail]
        assert [MESH.next[number]] == (after or [number])
        assert [MESH.previous[number]] == (before or [number])
    for vertex in range(MESH.size):
        out, into = ([k for k, edge in enumerate(edges) if edge[end] == vertex] for end in (0, 1))
        assert [MESH.outgoing[vertex]] == (out or into)
        assert [MESH.incoming[vertex]] == (into or out)
        assert (vertex in MESH.inner) == (bool(out) and bool(into))


def test_index_distance_is_that_of_the_graph_of_edges():
    edges = listed_edges()
    for i, (*first, component) in enumerate(edges):
        reached, distance, front = {i: 0}, 0, {i}
        while front:
            distance += 1
            ends = {vertex for k in front for vertex in edges[k][:2]}
            front = {k for k, edge in enumerate(edges) if k not in reached and ends & set(edge[:2])}
            reached |= dict.fromkeys(front, distance)
        found = MESH.index_distance(np.full(MESH.edges, i), np.arange(MESH.edges))
        assert found.tolist() == [reached.get(k, MESH.size) for k in range(MESH.edges)]
        assert (MESH.disjoint(np.array([i]), np.array([i])) == [False]).all()
        assert {edges[k][2] for k in reached} == {component}
        assert len(first) == 2


def test_scatter_is_the_transposed_incidence():
    rng = np.random.default_rng(3)
    at_tails, at_heads = rng.normal(size=(2, MESH.edges, 3))
    average, difference = MESH.average.toarray(), MESH.difference.toarray()
    tails, heads = average - 0.5 * difference, average + 0.5 * difference
    np.testing.assert_allclose(MESH.scatter(at_tails, at_heads), tails.T @ at_tails + heads.T @ at_heads)
    np.testing.assert_array_equal(tails.nonzero(), (np.arange(MESH.edges), MESH.tails))


@pytest.mark.parametrize(
    ("sizes", "closed", "reason"),
    [
        ((3, 1), (True, False), "component 2 has 1 vertex; an open polygon needs at least 2 different vertices"),
        ((2, 2), (False, True), "component 2 has 2 vertices; a closed polygon needs at least 3 different vertices"),
        ((3, 3), (False,), "closed is (False,); it must have True or False for each of 2 components"),
        ((3,), ("no",), "closed is ('no',); it must have True or False for each of 1 components"),
        ((3,), False, "closed is False; it must have True or False for each of 1 components"),
    ],
)
def test_refusals(sizes, closed, reason):
    with pytest.raises(CurveError) as caught:
        Mesh(sizes, closed)
    assert str(caught.value) == reason
    if closed is False:
        with pytest.raises(CurveError, match=r"^closed is False; it must have"):
            Curve.from_components([np.eye(3)], closed)


def test_what_is_for_closed_components_says_so():
    with pytest.raises(CurveError, match=r"^component 2 is open; knot types are for closed components$"):
        check_closed(opened(Curve.from_components([np.eye(3), np.eye(3) + 1]), 1), "knot types")


def test_there_is_one_way_along_an_arc():
    curve = opened(Curve.from_components([half_circle(6).vertices, torus_trefoil(9).vertices]), 0)
    edge = float(curve.edge_lengths[0])
    i, j = np.array([0, 6, 0, 2]), np.array([6, 1, 8, 2])
    np.testing.assert_allclose(arc_distance_of_vertices(curve, i, j), [6 * edge, 5 * edge, np.inf, 0])
    i, j = np.array([0, 5, 0]), np.array([5, 1, 7])
    np.testing.assert_allclose(arc_distance_of_pairs(curve, i, j, 0.5), [5 * edge, 4 * edge, np.inf])
    along = points_along(curve, np.zeros(3, dtype=np.intp), np.array([0.0, 2.5 * edge, 6 * edge]))
    np.testing.assert_allclose(along, [curve.vertices[0], curve.midpoints[2], curve.vertices[6]], atol=1e-15)


@pytest.mark.parametrize("vertices", [None, 40, 41])
def test_refined_arcs_are_the_same_arcs(vertices):
    curve = opened(Curve(torus_trefoil(30).vertices), 0)
    fine = refine(curve, vertices)
    assert vertices in (None, len(fine))
    assert fine.mesh.closed == (False,)
    assert np.array_equal(fine.vertices[[0, -1]], curve.vertices[[0, -1]])
    assert {tuple(p) for p in curve.vertices.tolist()} <= {tuple(p) for p in fine.vertices.tolist()}
