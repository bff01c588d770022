"""The ends of arcs: no fold is taken for free, by the program or by `verify`, against exact times."""

import itertools

import numpy as np
import pytest
from exact_decisions import meet
from mobius_flow.core import Curve, Mesh
from mobius_flow.core.collision import free_motion, is_free, minimal_gap, survives_rounding
from mobius_flow.core.collision.gap import folds
from shapes import opened, straight_arc, torus_trefoil
from trajectory_files import checked, trajectory


def verdict(folder, mesh, *frames):
    return checked(folder, trajectory((mesh.component_sizes, frames), component_closed_000=np.array(mesh.closed)))


def collapses(mesh, start, end):
    """Whether an arc is not embedded at some time: exact, by the definition, but for folds at vertices in between."""
    tails, heads = mesh.tails.tolist(), mesh.heads.tolist()
    edges = list(zip(tails, heads, strict=True))
    segments = [(*a, *b) for a, b in itertools.combinations(edges, 2) if not set(a) & set(b)]
    if len(edges) == 1:
        segments += [(0, 0, 1, 1)]
    for (a, b), (c, d) in itertools.pairwise(edges):  # the end that two neighbours do not share, on the other edge
        segments += [(a, a, c, d), (d, d, a, b)]
    return any(meet(start[[*segment]], end[[*segment]]) for segment in segments)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("size", [2, 3, 4, 5])
def test_random_motions_of_arcs(tmp_path, size, dimension):
    """On a small lattice, where edges fold and shrink exactly, and in general position."""
    mesh, rng = Mesh((size,), (False,)), np.random.default_rng(100 * size + dimension)
    found = {True: 0, False: 0}
    for k in range(30):
        start, end = rng.integers(-1, 2, (2, size, dimension)) * 1.0
        if k % 3 == 0:
            start = np.cumsum(rng.normal(size=(size, dimension)), axis=0)
            end = start + rng.normal(size=start.shape, scale=rng.choice([0.1, 1.0]))
        collapse = collapses(mesh, start, end)
        found[collapse] += 1
        assert is_free(mesh, start, end) <= (not collapse), (start, end)
        free = free_motion(mesh, start, end)
        assert free.proved <= (not collapse), (start, end)
        assert verdict(tmp_path, mesh, start, end).accepted == (not collapses(mesh, start, start) and not collapse)
        if k % 3 == 0:  # in general position nothing free is refused
            assert free.proved == (not collapse)
    assert min(found.values()) > 1


def turned(angle):
    return np.array([np.cos(angle), np.sin(angle), 0.0])


@pytest.mark.parametrize("backwards", [False, True])
@pytest.mark.parametrize("length", [0.5, 1.0, 2.0])
def test_an_end_that_swings_through_the_next_edge(tmp_path, length, backwards):
    middle = np.zeros(3)
    frames = [np.stack([length * turned(angle), middle, turned(0.0)]) for angle in (0.3, -0.3)]
    if backwards:
        frames = [frame[::-1].copy() for frame in frames]
    mesh = Mesh((3,), (False,))
    free = free_motion(mesh, *frames)
    assert not free.proved
    assert sorted(free.contact.edges) == [0, 1]
    assert 0.48 < free.time <= 0.5
    rejected = verdict(tmp_path, mesh, *frames)
    assert not rejected.accepted
    assert sorted(rejected.edges) == [0, 1]
    assert "an open polygon collapses at vertex" in rejected.reason


@pytest.mark.parametrize("shift", [1e-6, -1e-6])
def test_an_end_that_swings_past_the_next_edge_is_free(tmp_path, shift):
    frames = [np.stack([turned(angle) + shift * np.eye(3)[2], np.zeros(3), 2 * turned(0.0)]) for angle in (0.3, -0.3)]
    mesh = Mesh((3,), (False,))
    assert is_free(mesh, *frames)
    assert verdict(tmp_path, mesh, *frames).accepted


def test_a_single_edge_that_turns_inside_out(tmp_path):
    mesh, frame = Mesh((2,), (False,)), np.array([[0.0, 0.0, 0.0], [1.0, 2.0, 3.0]])
    free = free_motion(mesh, frame, frame[::-1])
    assert not free.proved
    assert free.contact.edges == (0, 0)
    rejected = verdict(tmp_path, mesh, frame, frame[::-1])
    assert rejected.edges == (0, 0)


def test_numbers_of_edges_are_not_those_of_their_tails(tmp_path):
    """After an arc an edge has a smaller number than its tail."""
    arc, square = straight_arc(3).vertices, np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]) + 9.0
    start = Curve.from_components([arc, square], [False, True])
    end = start.vertices.copy()
    end[4:] = end[[5, 4, 7, 6]]  # a reflection through a segment: two opposite edges go through each other
    free = free_motion(start.mesh, start.vertices, end)
    rejected = verdict(tmp_path, start.mesh, start.vertices, end)
    assert not rejected.accepted
    assert {*free.contact.edges} <= {3, 4, 5, 6}
    assert {*rejected.edges} <= {3, 4, 5, 6}


def test_closed_polygons_of_four_and_more_have_no_folds():
    assert folds(Mesh((4, 5, 9))).shape == (4, 0)
    assert folds(Mesh((3,))).T.tolist() == [[0, 0, 1, 2], [1, 1, 2, 0], [2, 2, 0, 1]]
    assert folds(Mesh((4, 3), (True, False))).T.tolist() == [[4, 4, 5, 6], [6, 6, 4, 5]]


def test_ends_that_rounding_could_fold():
    """Far from the origin the end might be on the other side of the edge that it nearly lies on."""
    bent = np.array([[1.0, 1e-6, 0.0], [0.0, 0.0, 0.0], [2.0, 0.0, 0.0]])
    arcs = [Curve(bent + far, Mesh((3,), (False,))) for far in (0.0, 1e9)]
    assert [survives_rounding(arc) for arc in arcs] == [True, False]
    assert survives_rounding(straight_arc(1))


def test_gaps_of_arcs():
    assert minimal_gap(straight_arc(2)) == (np.inf, None)
    assert minimal_gap(straight_arc(3))[0] == pytest.approx(1.0)
    knot = torus_trefoil(40)
    everywhere = minimal_gap(knot)[0]
    assert minimal_gap(opened(knot, 0))[0] >= everywhere
