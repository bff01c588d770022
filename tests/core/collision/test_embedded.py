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
def test_embedded_curves_pass(curve: Curve, scale: float) -> None:
    check_embedded(curve.with_vertices(scale * curve.vertices))


def refusal(curve: Curve) -> str:
    with pytest.raises(CurveError) as caught:
        check_embedded(curve)
    return str(caught.value)


def test_repeated_point() -> None:
    points = SQUARE[:2] + SQUARE[1:]
    expected = "component 1: vertices 2 and 3 are the same point (1, 0, 0); remove one of them"
    assert refusal(Curve(points)) == expected
    closing = Curve.from_components([FAR_SQUARE, [*SQUARE, SQUARE[0]]])
    assert refusal(closing) == "component 2: vertices 5 and 1 are the same point (0, 0, 0); remove one of them"


@pytest.mark.parametrize("m", [2, 3, 4])
def test_doubled_back(m: int) -> None:
    spike = np.zeros((5, m))
    spike[:, :2] = [[0, 0], [1, 0], [3, 3], [2, 2], [0, 1]]
    spike[1, :2] = [1, 1]
    expected = f"component 1: edge 3 doubles back on edge 2 at vertex 3, (3, 3{', 0' * (m - 2)}); move or remove it"
    assert refusal(Curve(spike)) == expected


def test_flat_triangle_is_doubled_back() -> None:
    for flat in ([[0.0, 0.0], [1.0, 0.0], [3.0, 0.0]], [[0.1, 0.1, 0.1], [0.3, 0.3, 0.3], [0.2, 0.2, 0.2]]):
        assert "doubles back" in refusal(Curve(flat))


def test_crossing_in_the_plane() -> None:
    eight = Curve([[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]])
    assert refusal(eight) == "component 1: edges 1 and 3 touch or cross near (1, 1); move the strands apart"


def test_touching_in_space() -> None:
    pentagon = Curve([*SQUARE, [0.5, 0.0, 0.0], [-1.0, 0.5, 0.5]])
    message = refusal(pentagon)
    assert message.startswith("component 1: edges 1 and ")
    assert message.endswith("touch or cross near (0.5, 0, 0); move the strands apart")


def test_two_components() -> None:
    needle = [[5.5, 5.0, 4.0], [5.5, 5.0, 6.0], [9.0, 9.0, 9.0]]
    curve = Curve.from_components([FAR_SQUARE, needle])
    expected = "edge 1 of component 1 and edge 1 of component 2 touch or cross near (5.5, 5, 5); move the strands apart"
    assert refusal(curve) == expected


@pytest.mark.parametrize("m", [3, 4])
def test_curve_run_through_twice(m: int) -> None:
    once = regular_polygon(40, dimension=m).vertices
    assert "edges 1 and 40 touch" in refusal(Curve(np.concatenate([once, once])))


@pytest.mark.parametrize("gap", [1e-3, 1e-9, 1e-14])
def test_near_strands_pass(gap: float) -> None:
    curve = Curve.from_components([SQUARE, np.asarray(SQUARE) + np.array([0.0, 0.0, gap])])
    check_embedded(curve)


def test_lattice_polygon_with_parallel_and_collinear_edges() -> None:
    path = [
        [0, 0, 0],
        [1, 0, 0],
        [2, 0, 0],
        [3, 0, 0],
        [3, 1, 0],
        [2, 1, 0],
        [1, 1, 0],
        [0, 1, 0],
        [0, 1, 1],
        [0, 0, 1],
    ]
    check_embedded(Curve(path))
    path[6] = [1, 0, 0]
    assert "touch or cross near (1, 0, 0)" in refusal(Curve(path))


@pytest.mark.parametrize("m", [4, 5, 40])
@pytest.mark.parametrize("scale", [1.0, 1e-6, 1e6])
def test_crossings_in_more_dimensions(m: int, scale: float) -> None:
    """An eight that crosses itself, or nearly, turned into a random direction of R^m."""
    turn = np.linalg.qr(np.random.default_rng(9).normal(size=(m, m)))[0]
    eight = np.zeros((4, m))
    eight[:, :2] = [[0, 0], [2, 2], [2, 0], [0, 2]]
    message = refusal(Curve(scale * eight @ turn + scale))
    assert message.startswith("component 1: edges 1 and 3 touch or cross near (")
    eight[2:, m - 1] = 1e-9  # one strand passes the other in the last dimension
    check_embedded(Curve(scale * eight @ turn + scale))


def test_thousands_of_edges_within_rounding_of_each_other_are_refused_in_time() -> None:
    row, column = np.divmod(np.arange(72), 9)
    tails = 1.0 + 2.0**-52 * np.stack([row, column, 0 * row], axis=1)
    arcs = np.stack([tails, tails + np.array([[0.5, 0.25, 0.375]])], axis=1)
    check_embedded(Curve.from_components(arcs[:12], [False] * 12))
    assert "thousands of others are so close" in refusal(Curve.from_components(arcs, [False] * 72))


def test_thousands_of_edges_on_each_other_need_little_memory() -> None:
    """The first contact is enough: 9,000 vertices on three places are 13 million pairs of edges that coincide."""
    tracemalloc.start()
    try:
        assert "touch or cross" in refusal(Curve(np.tile(np.eye(3), (3000, 1))))
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < 2e8
