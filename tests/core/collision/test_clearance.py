"""Curves that touch obstacles are refused with the place, those that are clear of them are not."""

import numpy as np
import pytest
from mobius_flow.core import Curve, CurveError, Obstacle
from mobius_flow.core.collision import check_clear, survives_rounding
from shapes import hopf_link, regular_polygon, torus_trefoil
from solids import box, plate, rod, sphere

SQUARE = Curve([[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [1.0, -1.0, 1.0], [1.0, -1.0, -1.0]])


def refusal(curve: Curve, *obstacles: Obstacle) -> CurveError:
    with pytest.raises(CurveError) as error:
        check_clear(curve, obstacles)
    return error.value


@pytest.mark.parametrize("scale", [1.0, 2.0**-100, 2.0**100])
@pytest.mark.parametrize("obstacle", [box(-4, 4), sphere(9.0), plate(1.5), rod(0, 0), rod(7, 2)])
def test_a_curve_beside_or_inside_is_clear(obstacle: Obstacle, scale: float) -> None:
    curve = torus_trefoil(60)
    check_clear(curve.with_vertices(scale * curve.vertices), (Obstacle(scale * obstacle.vertices, obstacle.faces),))


def test_without_obstacles_everything_is_clear() -> None:
    check_clear(regular_polygon(5, dimension=2), ())


def test_an_edge_that_pierces_is_named_with_the_place() -> None:
    error = refusal(SQUARE, box(5, 6), plate(0.25, name="tile"))
    assert str(error) == "edge 1 of component 1 pierces obstacle tile at (1, 1, 0.25); move one of them away"
    assert error.place.vertices == (0, 1)
    assert error.place.position == pytest.approx((1.0, 1.0, 0.25))


def test_components_count_their_own_edges() -> None:
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
def test_touching_and_nearly_touching(obstacle: Obstacle, said: str) -> None:
    error = refusal(SQUARE, obstacle)
    assert error.place is not None
    with pytest.raises(CurveError, match=said):
        check_clear(SQUARE, (obstacle,))


@pytest.mark.parametrize("dimension", [2, 4])
def test_obstacles_are_for_curves_in_space(dimension: int) -> None:
    error = refusal(regular_polygon(5, dimension), box(2, 3))
    assert f"the curve has dimension {dimension}, but obstacles are in space" in str(error)


@pytest.mark.parametrize("seed", range(30))
def test_every_piercing_edge_is_found(seed: int) -> None:
    rng = np.random.default_rng(seed)
    curve = Curve(rng.normal(size=(6, 3)))
    obstacle = Obstacle(rng.normal(size=(6, 3)) + rng.choice([0.0, 1.5]), [[0, 1, 2], [3, 4, 5]])
    ends = np.stack([curve.vertices, curve.vertices[curve.mesh.heads]], axis=1)
    if any(pierces(p, q, triangle) for p, q in ends for triangle in obstacle.corners):
        assert "pierces" in str(refusal(curve, obstacle))
    else:
        check_clear(curve, (obstacle,))


def pierces(p: np.ndarray, q: np.ndarray, triangle: np.ndarray) -> bool:
    matrix = np.stack([p - q, triangle[1] - triangle[0], triangle[2] - triangle[0]], axis=1)
    s, r, t = np.linalg.solve(matrix, p - triangle[0])
    return bool(0 <= s <= 1 and r >= 0 and t >= 0 and r + t <= 1)


def test_rounding_must_not_reach_an_obstacle() -> None:
    curve = hopf_link(20)
    assert survives_rounding(curve, (plate(2.0),))
    assert survives_rounding(curve, (plate(1.0 + 1e-11),))
    assert not survives_rounding(curve, (plate(1.0 + 4e-16),))
