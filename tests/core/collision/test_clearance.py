"""Distances of strands from each other and from obstacles, bounded from below."""

import numpy as np
import pytest
from mobius_flow.core import Curve, CurveError, Mesh, Obstacle
from mobius_flow.core.collision import check_clear, minimal_gap, survives_rounding
from scipy.optimize import lsq_linear
from shapes import hopf_link, regular_polygon, torus_trefoil
from solids import box, plate, rod, sphere

SQUARE = Curve([[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [1.0, -1.0, 1.0], [1.0, -1.0, -1.0]])


def refusal(curve, *obstacles):
    with pytest.raises(CurveError) as error:
        check_clear(curve, obstacles)
    return error.value


@pytest.mark.parametrize("scale", [1.0, 2.0**-100, 2.0**100])
@pytest.mark.parametrize("obstacle", [box(-4, 4), sphere(9.0), plate(1.5), rod(0, 0), rod(7, 2)])
def test_a_curve_beside_or_inside_is_clear(obstacle, scale):
    curve = torus_trefoil(60)
    check_clear(curve.with_vertices(scale * curve.vertices), (Obstacle(scale * obstacle.vertices, obstacle.faces),))


def test_without_obstacles_everything_is_clear():
    check_clear(regular_polygon(5, dimension=2), ())


def test_an_edge_that_pierces_is_named_with_the_place():
    error = refusal(SQUARE, box(5, 6), plate(0.25, name="tile"))
    assert str(error) == "edge 1 of component 1 pierces obstacle tile at (1, 1, 0.25); move one of them away"
    assert error.place.vertices == (0, 1)
    assert error.place.position == pytest.approx((1.0, 1.0, 0.25))


def test_components_count_their_own_edges():
    link = Curve.from_components([regular_polygon(7).vertices, np.array([5.0, 0.0, 0.0]) + SQUARE.vertices])
    assert str(refusal(link, Obstacle(np.array([104.0, 0, 0]) + plate(0.25).vertices, plate(0).faces))).startswith(
        "edge 1 of component 2 pierces obstacle at (6, 1, 0.25)"
    )


@pytest.mark.parametrize(
    ("obstacle", "said"),
    [
        (plate(1.0), r"edge 1 of component 1 touches obstacle plate at \(1, 1, 1\)"),
        (
            Obstacle([[1.0, 0.0, 1.0], [5.0, 0, 1], [5.0, 1, 1]], [[0, 1, 2]]),
            r"edge 2 of component 1 touches obstacle at \(1, 0, 1\)",
        ),
        (rod(1.0, 1.0), r"edge 1 of component 1 touches obstacle rod at \(1, 1, -1\)"),
        (Obstacle([[1.0, 0.0, 1.0]], [[0, 0]]), r"edge 2 of component 1 touches obstacle at \(1, 0, 1\)"),
        (plate(1.0 + 1e-12), "edge 1 of component 1 comes too near to obstacle plate"),
    ],
)
def test_touching_and_nearly_touching(obstacle, said):
    error = refusal(SQUARE, obstacle)
    assert error.place is not None
    with pytest.raises(CurveError, match=said):
        check_clear(SQUARE, (obstacle,))


@pytest.mark.parametrize("dimension", [2, 4])
def test_obstacles_are_for_curves_in_space(dimension):
    error = refusal(regular_polygon(5, dimension), box(2, 3))
    assert f"the curve has dimension {dimension}, but obstacles are in space" in str(error)


@pytest.mark.parametrize("seed", range(30))
def test_every_piercing_edge_is_found(seed):
    rng = np.random.default_rng(seed)
    curve = Curve(rng.normal(size=(6, 3)))
    obstacle = Obstacle(rng.normal(size=(6, 3)) + rng.choice([0.0, 1.5]), [[0, 1, 2], [3, 4, 5]])
    ends = np.stack([curve.vertices, curve.vertices[curve.mesh.heads]], axis=1)
    if any(pierces(p, q, triangle) for p, q in ends for triangle in obstacle.corners):
        assert "pierces" in str(refusal(curve, obstacle))
    else:
        check_clear(curve, (obstacle,))


def pierces(p, q, triangle):
    matrix = np.stack([p - q, triangle[1] - triangle[0], triangle[2] - triangle[0]], axis=1)
    s, r, t = np.linalg.solve(matrix, p - triangle[0])
    return bool(0 <= s <= 1 and r >= 0 and t >= 0 and r + t <= 1)


def test_rounding_must_not_reach_an_obstacle():
    curve = hopf_link(20)
    assert survives_rounding(curve, (plate(2.0),))
    assert survives_rounding(curve, (plate(1.0 + 1e-11),))
    assert not survives_rounding(curve, (plate(1.0 + 4e-16),))


def segment_distance(corners):
    """By a bounded least-squares solver."""
    x0, x1, y0, y1 = corners
    fit = lsq_linear(np.stack([x1 - x0, y0 - y1], axis=1), y0 - x0, bounds=(0, 1), tol=1e-14)
    return float(np.sqrt(2 * fit.cost))


def brute_force(curve):
    mesh, distances = curve.mesh, []
    for i, j in zip(*np.triu_indices(len(curve), 1), strict=True):
        if mesh.disjoint(i, j):
            distances.append(segment_distance(curve.vertices[[i, mesh.heads[i], j, mesh.heads[j]]]))
    return min(distances)


@pytest.mark.parametrize("m", [2, 3, 4, 7])
@pytest.mark.parametrize("sizes", [(4,), (12,), (3, 3), (5, 3, 4)])
def test_against_brute_force(sizes, m):
    rng = np.random.default_rng(91)
    for offset in (0.0, 3.0):
        parts = [rng.normal(size=(k, m)) + offset * c for c, k in enumerate(sizes)]
        curve = Curve.from_components(parts)
        gap, pair = minimal_gap(curve)
        corners = curve.vertices[[pair[0], curve.mesh.heads[pair[0]], pair[1], curve.mesh.heads[pair[1]]]]
        assert gap == pytest.approx(brute_force(curve), rel=1e-6, abs=1e-7)
        assert gap == pytest.approx(segment_distance(corners), rel=1e-6, abs=1e-7)


def test_crossing_in_the_plane_has_no_gap():
    assert minimal_gap(Curve([[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]]))[0] == 0.0


@pytest.mark.parametrize("n", [5, 64, 301])
def test_regular_polygon(n):
    """Edges one apart are nearest, an edge's length away from each other (for n ≥ 6)."""
    gap, _ = minimal_gap(regular_polygon(n))
    assert gap == pytest.approx(2 * np.sin(np.pi / n), rel=1e-12)


@pytest.mark.parametrize("scale", [1.0, 1e-6, 1e6, 1e-200])
def test_parallel_strands(scale):
    square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    curve = Curve.from_components([scale * square, scale * (square + np.array([0.25, 0.0, 1e-3]))])
    gap, pair = minimal_gap(curve)
    assert gap == pytest.approx(1e-3 * scale, rel=1e-12)
    assert pair is not None
    assert curve.mesh.component[list(pair)].tolist() in ([0, 1], [1, 0])


def test_links_and_knots():
    assert minimal_gap(hopf_link(400))[0] == pytest.approx(2 * np.sin(np.pi / 400), rel=1e-3)
    assert minimal_gap(torus_trefoil(30))[0] == pytest.approx(brute_force(torus_trefoil(30)), rel=1e-9)


@pytest.mark.parametrize("gap", [0.0, 1e-15, 1e-13, 1e-12, 1e-9])
def test_edges_one_edge_apart_whose_gap_is_mostly_rounding(gap):
    curve = Curve([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0.5, gap, 0.0], [0, 1, 0]])
    found, pair = minimal_gap(curve)
    assert pair is not None
    assert found == pytest.approx(gap, abs=1e-15)


def test_triangles_whose_tree_has_padding():
    """Triangles give no first bound, and the empty boxes that make numbers even are no pairs of edges."""
    assert minimal_gap(regular_polygon(3)) == (np.inf, None)
    for count in (11, 75, 512):
        shifts = np.stack([3.0 * (np.arange(count) % 9), 3.0 * (np.arange(count) // 9), np.zeros(count)], axis=1)
        curve = Curve((np.eye(3) + shifts[:, None]).reshape(-1, 3), Mesh((3,) * count))
        assert minimal_gap(curve)[0] == pytest.approx(3 / np.sqrt(2))
