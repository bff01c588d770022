"""The floating-point filter allows for rounding and clearance, and looks at everything; see `test_decisions`, too."""

import numpy as np
from mobius_flow.core import Mesh
from mobius_flow.core.base.types import IntArray
from mobius_flow.core.proof import filter as leg_filter
from motions import Array
from shapes import torus_trefoil


def doubtful_pairs(start: Array, end: Array, heads: IntArray, clearance: float = 0.0) -> Array:
    """All of them, each by the vertices of its edges; shape (4, pairs)."""
    return np.concatenate([np.empty((4, 0)), *leg_filter.doubtful_pairs(start, end, heads, clearance)], axis=1)


def test_clearance() -> None:
    square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    link = np.concatenate([square, square + np.array([0.3, 0.2, 1e-6])])
    heads = Mesh((4, 4)).heads
    assert doubtful_pairs(link, link, heads).size == 0
    assert doubtful_pairs(link, link, heads, clearance=1e-7).size == 0
    assert doubtful_pairs(link, link, heads, clearance=1e-6).size > 0


def test_an_end_on_an_edge_is_doubtful_whichever_way_is_rounded() -> None:
    """Heights above the edge are 0, but for rounding; as many are positive as negative."""
    rng = np.random.default_rng(61)
    for part in rng.integers(1, 16, size=100):
        start = 16.0 * rng.integers(-(2**25), 2**25, size=(4, 3))
        start[0] = start[2] + part / 16 * (start[3] - start[2])
        pairs = doubtful_pairs(start, start, np.array([1, 1, 3, 3]))
        assert [0, 1, 2, 3] in np.sort(pairs, axis=0).T.tolist()


def test_a_step_of_a_knot_needs_no_exact_decision() -> None:
    rng, knot = np.random.default_rng(5), torus_trefoil(300)
    end = knot.vertices + 0.01 * rng.normal(size=knot.vertices.shape)
    assert doubtful_pairs(knot.vertices, end, knot.mesh.heads).size == 0


def test_all_pairs_are_looked_at() -> None:
    """With everything at one place nothing can be dropped."""
    points = np.zeros((30, 3))
    pairs = doubtful_pairs(points, points, Mesh((30,)).heads)
    assert pairs.shape == (4, 30 * 27 // 2)
