"""Scrambles keep the type: every move is checked again in exact arithmetic, every result by its invariants."""

import numpy as np
import pytest
from curve_checks import exact, exactly_pierced, strand_distance
from hypothesis import given, settings
from hypothesis import strategies as st
from knot_diagrams import pairwise_linking
from knot_type import knot_invariants
from mobius_flow.core.base.errors import CurveError
from mobius_flow.core.curve import Curve
from mobius_flow.core.knots import knot, scramble
from mobius_flow.core.knots.scrambles import Polygons, triangle_distances

POINTS = st.lists(st.integers(-6, 6), min_size=3, max_size=3).map(lambda p: np.array(p, dtype=np.float64) / 2)


@pytest.mark.parametrize("name", ["0_1", "3_1", "m3_1", "4_1", "6_2"])
@pytest.mark.parametrize("seed", [1, 3])
def test_type_is_kept(name: str, seed: int) -> None:
    curve = knot(name)
    messy = scramble(curve, seed, moves=3 * len(curve))
    assert knot_invariants(messy.vertices) == knot_invariants(curve.vertices)


@pytest.mark.parametrize("name", ["hopf", "whitehead", "borromean"])
def test_linking_is_kept(name: str) -> None:
    link = knot(name)
    messy = scramble(link, 5, moves=200)
    assert messy.mesh == link.mesh
    assert pairwise_linking(messy.components) == pairwise_linking(link.components)


def test_it_is_messy_and_keeps_its_gap() -> None:
    curve = knot("3_1")
    messy = scramble(curve, 7, gap=0.05)
    moved = np.linalg.norm(messy.vertices - curve.vertices, axis=1)
    center = curve.vertices.mean(axis=0)
    radius = np.linalg.norm(curve.vertices - center, axis=1).max()
    assert np.median(moved) > 0.3
    assert messy.edge_lengths.max() > 5 * messy.edge_lengths.min()
    assert strand_distance(messy, apart=1) > 0.04
    assert np.linalg.norm(messy.vertices - center, axis=1).max() <= radius * (1 + 1e-12)


@pytest.mark.slow
def test_moves_pierce_nothing_in_exact_arithmetic(monkeypatch: pytest.MonkeyPatch) -> None:
    curve = knot("4_1", 40)
    moves: list[tuple[int, np.ndarray]] = []

    class Recorded(Polygons):
        def can_move(self, vertex: int, position: np.ndarray) -> bool:
            possible = super().can_move(vertex, position)
            moves.extend([(vertex, position)] * possible)
            return possible

    monkeypatch.setattr("mobius_flow.core.knots.scrambles.Polygons", Recorded)
    scramble(curve, seed=11, moves=300)
    points = curve.vertices.copy()
    n, count = len(points), 0
    for v, position in moves:
        a, b = (v - 1) % n, (v + 1) % n
        for pivot in (a, b):
            triangle = (exact(points[pivot]), exact(points[v]), exact(position))
            for i in range(n):
                if pivot not in (i, (i + 1) % n) and v not in (i, (i + 1) % n):
                    assert not exactly_pierced(triangle, exact(points[i]), exact(points[(i + 1) % n]))
        points[v] = position
        count += 1
    assert count > 30


@given(triangle=st.tuples(POINTS, POINTS, POINTS), p=POINTS, q=POINTS)
@settings(max_examples=100, deadline=None)
def test_triangle_distance_is_never_too_large(
    triangle: tuple[np.ndarray, np.ndarray, np.ndarray], p: np.ndarray, q: np.ndarray
) -> None:
    corners = np.stack(triangle)
    found = float(triangle_distances(corners, p[None], q[None])[0])
    weights = np.array([(i, j, 12 - i - j) for i in range(13) for j in range(13 - i)]) / 12
    on_segment = p + np.linspace(0, 1, 25)[:, None] * (q - p)
    sampled = np.linalg.norm((weights @ corners)[:, None] - on_segment[None], axis=2).min()
    assert found <= sampled + 1e-12
    assert found >= sampled - np.ptp(corners, axis=0).max() / 6 - np.ptp(on_segment, axis=0).max() / 24
    pierced = exactly_pierced((exact(triangle[0]), exact(triangle[1]), exact(triangle[2])), exact(p), exact(q))
    assert not pierced or found <= 1e-12


def test_triangles_and_squares_can_be_scrambled() -> None:
    for corners in (3, 4, 5):
        t = 2 * np.pi * np.arange(corners) / corners
        curve = Curve(np.stack([np.cos(t), np.sin(t), 0 * t], axis=1))
        assert not np.array_equal(scramble(curve, 1).vertices, curve.vertices)


@pytest.mark.parametrize(
    "options",
    [{"moves": -1}, {"reach": 0.0}, {"reach": float("inf")}, {"gap": 0.0}, {"gap": 1e-9}, {"gap": float("nan")}],
)
def test_impossible_options(options: dict[str, float]) -> None:
    with pytest.raises(CurveError, match=r"moves|reach|gap"):
        scramble(knot("3_1"), 1, **options)  # type: ignore[arg-type]


def test_plane_curves_are_refused() -> None:
    with pytest.raises(CurveError, match="dimension 2"):
        scramble(Curve([[0, 0], [1, 0], [0, 1]]), 1)
