"""Curves that touch themselves are refused, with a sentence that says where."""

import tracemalloc

import numpy as np
import pytest
from mobius_flow.core import Curve, CurveError
from mobius_flow.core.collision import check_embedded
from shapes import hopf_link, regular_polygon, torus_trefoil

SQUARE = [[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
FAR_SQUARE = [[5.0, 5, 5], [6, 5, 5], [6, 6, 5], [5, 6, 5]]


@pytest.mark.parametrize("scale", [1.0, 1e-6, 1e6, 1e-300])
@pytest.mark.parametrize(
    "curve",
    [torus_trefoil(300), hopf_link(50), regular_polygon(3), regular_polygon(7, dimension=2), Curve(SQUARE)],
    ids=["trefoil", "link", "triangle", "plane", "square"],
)
def test_embedded_curves_pass(curve, scale):
    check_embedded(curve.with_vertices(scale * curve.vertices))


def refusal(curve):
    with pytest.raises(CurveError) as caught:
        check_embedded(curve)
    return str(caught.value)


SPIKE = [[0, 0], [1, 1], [3, 3], [2, 2], [0, 1]]
NEEDLE = [[5.5, 5.0, 4.0], [5.5, 5.0, 6.0], [9.0, 9.0, 9.0]]
SAME = "vertex {} of component {} and vertex {} of component {} are the same point {}; remove one of them"
TOUCH = "edge {} of component 1 and edge {} of component {} touch or cross near {}; move the strands apart"
BACK = "the curve doubles back at vertex {} of component 1, {}; move or remove it"


@pytest.mark.parametrize(
    ("parts", "said"),
    [
        ([SQUARE[:2] + SQUARE[1:]], SAME.format(2, 1, 3, 1, "(1, 0, 0)")),
        ([FAR_SQUARE, [*SQUARE, SQUARE[0]]], SAME.format(5, 2, 1, 2, "(0, 0, 0)")),
        *(([np.pad(SPIKE, ((0, 0), (0, m - 2)))], BACK.format(3, f"(3, 3{', 0' * (m - 2)})")) for m in (2, 3, 4)),
        ([[[0.0, 0.0], [1.0, 0.0], [3.0, 0.0]]], BACK.format(3, "(3, 0)")),
        ([[[0.1, 0.1, 0.1], [0.3, 0.3, 0.3], [0.2, 0.2, 0.2]]], BACK.format(2, "(0.3, 0.3, 0.3)")),
        ([[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]]], TOUCH.format(1, 3, 1, "(1, 1)")),
        ([[*SQUARE, [0.5, 0.0, 0.0], [-1.0, 0.5, 0.5]]], TOUCH.format(1, 4, 1, "(0.5, 0, 0)")),
        ([FAR_SQUARE, NEEDLE], TOUCH.format(1, 1, 2, "(5.5, 5, 5)")),
    ],
)
def test_what_is_wrong_is_named_with_the_place(parts, said):
    assert refusal(Curve.from_components([np.array(part, dtype=float) for part in parts])) == said


@pytest.mark.parametrize("m", [3, 4])
def test_curve_run_through_twice(m):
    once = regular_polygon(40, dimension=m).vertices
    assert "edge 1 of component 1 and edge 40 of component 1 touch" in refusal(Curve(np.concatenate([once, once])))


@pytest.mark.parametrize("gap", [1e-3, 1e-9, 1e-14])
def test_near_strands_pass(gap):
    curve = Curve.from_components([SQUARE, np.asarray(SQUARE) + np.array([0.0, 0.0, gap])])
    check_embedded(curve)


def test_lattice_polygon_with_parallel_and_collinear_edges():
    row = [[k, 0, 0] for k in range(4)]
    path = [*row, *([x, 1, 0] for x, _, _ in row[::-1]), [0, 1, 1], [0, 0, 1]]
    check_embedded(Curve(path))
    path[6] = [1, 0, 0]
    assert "touch or cross near (1, 0, 0)" in refusal(Curve(path))


@pytest.mark.parametrize("m", [4, 5, 40])
@pytest.mark.parametrize("scale", [1.0, 1e-6, 1e6])
def test_crossings_in_more_dimensions(m, scale):
    """An eight that crosses itself, or nearly, turned into a random direction of R^m."""
    turn = np.linalg.qr(np.random.default_rng(9).normal(size=(m, m)))[0]
    eight = np.zeros((4, m))
    eight[:, :2] = [[0, 0], [2, 2], [2, 0], [0, 2]]
    message = refusal(Curve(scale * eight @ turn + scale))
    assert message.startswith("edge 1 of component 1 and edge 3 of component 1 touch or cross near (")
    eight[2:, m - 1] = 1e-9  # one strand passes the other in the last dimension
    check_embedded(Curve(scale * eight @ turn + scale))


def test_thousands_of_edges_within_rounding_of_each_other_are_refused_in_time():
    row, column = np.divmod(np.arange(72), 9)
    tails = 1.0 + 2.0**-52 * np.stack([row, column, 0 * row], axis=1)
    arcs = np.stack([tails, tails + np.array([[0.5, 0.25, 0.375]])], axis=1)
    check_embedded(Curve.from_components(arcs[:12], [False] * 12))
    assert "thousands of others are so close" in refusal(Curve.from_components(arcs, [False] * 72))


def test_thousands_of_edges_on_each_other_need_little_memory():
    """The first contact is enough: 9,000 vertices on three places are 13 million pairs of edges that coincide."""
    tracemalloc.start()
    try:
        assert "touch or cross" in refusal(Curve(np.tile(np.eye(3), (3000, 1))))
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < 2e8
