"""Legs of ropes: nothing false is proved, what is clearly a rope is, and the checker, which shares no line, agrees.

MOBIUS_FLOW_MOTIONS=25000 makes it 100,000 random legs of pairs, in half an hour.
"""

import os

import numpy as np
import pytest
from mobius_flow.core import Curve, Mesh, Obstacle
from mobius_flow.core.collision import is_free, is_rope, rope_motion, thickness
from mobius_flow.core.collision.rope import Corners, _bends, shortcut
from mobius_flow.core.knots import knot
from mobius_flow.core.proof import checker
from shapes import regular_polygon

COUNT = int(os.environ.get("MOBIUS_FLOW_MOTIONS", "30"))
ARCS = Mesh((2, 2), (False, False))


def least_distance(start: np.ndarray, end: np.ndarray) -> float:
    """Of two edges, sampled in time; closest points by clamping, in plain loops."""
    best = np.inf
    for t in np.linspace(0.0, 1.0, 101):
        x0, x1, y0, y1 = (1 - t) * start + t * end
        e, f, w = x1 - x0, y1 - y0, x0 - y0
        ends = [(x0, y0, f), (x1, y0, f), (y0, x0, e), (y1, x0, e)]
        for p, q, g in ends:
            s = np.clip((p - q) @ g / max(g @ g, 1e-300), 0, 1)
            best = min(best, float(np.linalg.norm(p - q - s * g)))
        n = np.cross(e, f)
        if n @ n > 1e-20:
            s, r = np.cross(f, w) @ n / (n @ n), np.cross(e, w) @ n / (n @ n)
            if 0 <= s <= 1 and 0 <= r <= 1:
                best = min(best, float(abs(w @ n) / np.sqrt(n @ n)))
    return best


def motion(rng: np.random.Generator, kind: str) -> tuple[np.ndarray, np.ndarray]:
    if kind == "lattice":
        return tuple(rng.integers(-2, 3, (2, 4, 3)).astype(float))  # type: ignore[return-value]
    start, end = rng.standard_normal((2, 4, 3))
    if kind == "parallel":
        start[3], end[3] = start[2] + start[1] - start[0], end[2] + end[1] - end[0]
    if kind == "near":
        end = start + 0.3 * rng.standard_normal((4, 3))
    return start, end


@pytest.mark.parametrize("kind", ["gaussian", "near", "parallel", "lattice"])
def test_pairs_against_exact_decisions_and_samples(kind: str) -> None:
    rng, proved, free, blunt = np.random.default_rng(2027), 0, 0, 0
    for _ in range(COUNT):
        start, end = motion(rng, kind)
        sampled = least_distance(start, end)
        radius = 0.5 * sampled * (1 + rng.choice([-0.3, -0.01, -1e-4, 1e-4, 0.01, 0.3]))
        if radius < 1e-6:
            continue
        found = is_rope(ARCS, start, end, np.array([radius, radius]))
        *ways, scale = checker.whole([*start, *end, (radius,)])
        moving = [(ways[k], ways[k + 4]) for k in range(4)]
        exact, clear = (checker.stay_apart(moving[:2], moving[2:], k * scale[0] // 50) for k in (100, 105))
        assert exact or not found
        assert not (exact and 2 * radius > sampled), (start.tolist(), end.tolist(), radius)
        proved, free, blunt = proved + found, free + exact, blunt + (clear and not found)
    assert blunt <= COUNT / 50
    assert 0.6 * free <= proved <= free


@pytest.mark.parametrize(("name", "share"), [("3_1", 0.999), ("L6a4", 0.999), ("goeritz", 0.9)])
def test_thickness_is_the_largest_radius_of_smooth_curves(name: str, share: float) -> None:
    """But for sharp corners, where more than half of an edge may be an arc's, and more than half a circle is tested."""
    curve = knot(name, 200)
    thick = thickness(curve)
    radii = np.ones(len(curve.mesh.component_sizes))
    assert is_rope(curve.mesh, curve.vertices, curve.vertices, share * thick * radii)
    assert not is_rope(curve.mesh, curve.vertices, curve.vertices, 2.1 * thick * radii)


@pytest.mark.parametrize("edges", [4, 5, 24])
def test_regular_polygons(edges: int) -> None:
    """They are ropes up to the radius of their inscribed circle, which is that of all arcs at once."""
    polygon = regular_polygon(edges)
    inscribed = np.cos(np.pi / edges)
    for share, expected in ((0.99, True), (1.01, False)):
        found = is_rope(polygon.mesh, polygon.vertices, polygon.vertices, np.array([share * inscribed]))
        assert found is expected


def test_a_motion_stops_where_strands_come_too_near() -> None:
    """Two parallel strands approach from a distance of 1 to none: ropes of .1 until it is .2."""
    t = np.linspace(0.0, 1.0, 11)
    start = [np.stack([t, 0 * t, np.full(11, z)], axis=1) for z in (0.0, 1.0)]
    curve = Curve.from_components(start, closed=(False, False))
    end = curve.vertices * [1.0, 1.0, 0.0]
    found = rope_motion(curve.mesh, curve.vertices, end, np.array([0.1, 0.1]))
    assert 0.75 < found.time <= 0.8
    assert not found.proved


def test_a_corner_gets_sharper() -> None:
    """A right angle with legs of 1 bends at radius ½; it is folded until its legs are parallel."""
    mesh = Mesh((3,), (False,))
    start = np.array([[1.0, 0, 0], [0, 0, 0], [0, 1.0, 0]])
    end = np.array([[1.0, 0, 0], [0, 0, 0], [1.0, 0.2, 0]])
    found = rope_motion(mesh, start, end, np.array([0.5]))
    assert 0.0 < found.time < 0.9
    assert is_rope(mesh, start, 0.9 * start + 0.1 * end, np.array([0.5]))
    assert not is_rope(mesh, start, start, np.array([1.01]))  # all of an edge, since its other end is straight


def test_an_obstacle_is_as_far_as_the_radius() -> None:
    wall = Obstacle([[-5.0, -5, 0], [5, -5, 0], [0, 9, 0]], [[0, 1, 2]])
    mesh = Mesh((2,), (False,))
    start, end = np.array([[0.0, 0, 1], [1, 0, 1]]), np.array([[0.0, 0, 0.5], [1, 0, 0.5]])
    assert is_rope(mesh, start, end, np.array([0.49]), [wall])
    found = rope_motion(mesh, start, end, np.array([0.6]), [wall])
    assert 0.7 < found.time <= 0.8
    assert found.contact is not None
    assert found.contact.obstacle is not None


def test_ropes_are_free_of_contact() -> None:
    rng = np.random.default_rng(5)
    curve = knot("5_1", 80)
    radius = np.array([0.9 * thickness(curve)])
    proved = 0
    for size in np.geomspace(1e-3, 1.0, 12 * (1 + COUNT // 30)):
        end = curve.vertices + size * radius[0] * rng.standard_normal((80, 3))
        if is_rope(curve.mesh, curve.vertices, end, radius):
            proved += 1
            assert is_free(curve.mesh, curve.vertices, end)
            for t in np.linspace(0, 1, 9):
                middle = curve.with_vertices((1 - t) * curve.vertices + t * end)
                assert thickness(middle) > 0.85 * radius[0]
    assert proved > 3


def test_bounds_of_corners() -> None:
    rng = np.random.default_rng(11)
    e, f = (tuple(rng.standard_normal((2, 3, 500)) * 0.1 + [[[1.0]] * 3] * 2) for _ in range(2))
    low, high, _, _ = Corners(e, f).tangents()
    for t in np.linspace(0, 1, 21):
        u, v = ((1 - t) * each[0] + t * each[1] for each in (e, f))
        half = np.arctan2(np.linalg.norm(np.cross(u, v, axis=0), axis=0), np.sum(u * v, axis=0)) / 2
        assert (low <= np.tan(half)).all()
        assert (np.tan(half) <= high).all()


def test_what_arcs_save_is_not_overrated() -> None:
    x = np.linspace(0.0, 60.0, 600_001)
    exact = x - np.arctan(x)
    assert (shortcut(x) <= exact + 1e-15).all()
    assert (shortcut(x) >= exact - 0.03).all()


def test_what_arcs_save_on_the_way() -> None:
    """Each corner of a hexagon turns by 60°; those at the ends of arcs, and corners on the way that straighten, save
    none.
    """
    hexagon = regular_polygon(6)
    spans = [p.T[:, hexagon.mesh.heads] - p.T[:, hexagon.mesh.tails] for p in [hexagon.vertices] * 2]
    saved = _bends(hexagon.mesh, spans, np.full(6, 0.1))[2]
    np.testing.assert_allclose(saved, 0.1 * (2 * np.tan(np.pi / 6) - np.pi / 3), rtol=0.01)
    straight = [spans[0], np.tile([[1.0], [0.0], [0.0]], 6)]
    assert (_bends(hexagon.mesh, straight, np.full(6, 0.1))[2] < 0.2 * saved).all()
