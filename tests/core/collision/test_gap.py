"""The smallest distance between non-neighbour edges."""

import numpy as np
import pytest
from mobius_flow.core import Curve, Mesh
from mobius_flow.core.collision import minimal_gap
from scipy.optimize import lsq_linear
from shapes import hopf_link, regular_polygon, torus_trefoil


def segment_distance(corners: np.ndarray) -> float:
    """By a bounded least-squares solver."""
    x0, x1, y0, y1 = corners
    fit = lsq_linear(np.stack([x1 - x0, y0 - y1], axis=1), y0 - x0, bounds=(0, 1), tol=1e-14)
    return float(np.sqrt(2 * fit.cost))


def brute_force(curve: Curve) -> float:
    mesh, distances = curve.mesh, []
    for i, j in zip(*np.triu_indices(len(curve), 1), strict=True):
        if mesh.disjoint(i, j):
            distances.append(segment_distance(curve.vertices[[i, mesh.heads[i], j, mesh.heads[j]]]))
    return min(distances)


@pytest.mark.parametrize("m", [2, 3, 4, 7])
@pytest.mark.parametrize("sizes", [(4,), (12,), (3, 3), (5, 3, 4)])
def test_against_brute_force(sizes: tuple[int, ...], m: int) -> None:
    rng = np.random.default_rng(91)
    for offset in (0.0, 3.0):
        parts = [rng.normal(size=(k, m)) + offset * c for c, k in enumerate(sizes)]
        curve = Curve.from_components(parts)
        gap, pair = minimal_gap(curve)
        corners = curve.vertices[[pair[0], curve.mesh.heads[pair[0]], pair[1], curve.mesh.heads[pair[1]]]]
        assert gap == pytest.approx(brute_force(curve), rel=1e-6, abs=1e-7)
        assert gap == pytest.approx(segment_distance(corners), rel=1e-6, abs=1e-7)


def test_crossing_in_the_plane_has_no_gap() -> None:
    assert minimal_gap(Curve([[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]]))[0] == 0.0


@pytest.mark.parametrize("n", [5, 64, 301])
def test_regular_polygon(n: int) -> None:
    """Edges one apart are nearest, an edge's length away from each other (for n ≥ 6)."""
    gap, _ = minimal_gap(regular_polygon(n))
    assert gap == pytest.approx(2 * np.sin(np.pi / n), rel=1e-12)


@pytest.mark.parametrize("scale", [1.0, 1e-6, 1e6, 1e-200])
def test_parallel_strands(scale: float) -> None:
    square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    curve = Curve.from_components([scale * square, scale * (square + np.array([0.25, 0.0, 1e-3]))])
    gap, pair = minimal_gap(curve)
    assert gap == pytest.approx(1e-3 * scale, rel=1e-12)
    assert pair is not None
    assert curve.mesh.component[list(pair)].tolist() in ([0, 1], [1, 0])


def test_links_and_knots() -> None:
    assert minimal_gap(hopf_link(400))[0] == pytest.approx(2 * np.sin(np.pi / 400), rel=1e-3)
    assert minimal_gap(torus_trefoil(30))[0] == pytest.approx(brute_force(torus_trefoil(30)), rel=1e-9)


@pytest.mark.parametrize("gap", [0.0, 1e-15, 1e-13, 1e-12, 1e-9])
def test_edges_one_edge_apart_whose_gap_is_mostly_rounding(gap: float) -> None:
    curve = Curve([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0.5, gap, 0.0], [0, 1, 0]])
    found, pair = minimal_gap(curve)
    assert pair is not None
    assert found == pytest.approx(gap, abs=1e-15)


def test_triangles_whose_tree_has_padding() -> None:
    """Triangles give no first bound, and the empty boxes that make numbers even are no pairs of edges."""
    assert minimal_gap(regular_polygon(3)) == (np.inf, None)
    for count in (11, 75, 512):
        shifts = np.stack([3.0 * (np.arange(count) % 9), 3.0 * (np.arange(count) // 9), np.zeros(count)], axis=1)
        curve = Curve((np.eye(3) + shifts[:, None]).reshape(-1, 3), Mesh((3,) * count))
        assert minimal_gap(curve)[0] == pytest.approx(3 / np.sqrt(2))
