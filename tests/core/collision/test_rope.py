"""Legs of ropes: nothing false is proved, what is clearly a rope is, and the checker, which shares no line, agrees.

MOBIUS_FLOW_MOTIONS=25000 makes it 100,000 random legs of pairs.
"""

import os

import numpy as np
import pytest
from mobius_flow.core import Curve, Mesh, Obstacle
from mobius_flow.core.collision import is_free, is_rope, rope_motion, thickness
from mobius_flow.core.collision.rope import Corners, _bends, _lost, shortcut
from mobius_flow.core.energies.edge_pairs import EdgePairs
from mobius_flow.core.energies.rope import closest
from mobius_flow.core.knots import knot
from mobius_flow.core.proof import checker
from shapes import regular_polygon

COUNT = int(os.environ.get("MOBIUS_FLOW_MOTIONS", "20"))
ARCS = Mesh((2, 2), (False, False))


def squared_distance(legs, width):
    """8 (|x − y|² − width²) for points x, y of moving edges: of degree 2 in their places and in time, of integers.

    Its coefficients in Bernstein's basis, shape (legs, 3, 3, 3), from vertices, shape (2, legs, 4, 3).
    """
    x0, x1, y0, y1 = np.moveaxis(legs, 2, 0)
    vectors = {"D": x0 - y0, "e": x1 - x0, "f": y0 - y1}
    one, twice, square = np.array([[1, 1, 1], [0, 1, 2], [0, 0, 1]], dtype=object)  # 1, 2 s and s²

    def term(u, v, s, t):
        """4 ⟨u, v⟩ times functions of the places."""
        (a, b), (c, d) = vectors[u], vectors[v]
        over_time = np.stack([4 * (a * c).sum(1), 2 * (a * d + b * c).sum(1), 4 * (b * d).sum(1)], axis=1)
        return np.asarray(s[:, None, None] * t[:, None] * over_time[:, None, None, :])

    total = term("D", "D", one, one) + term("D", "e", twice, one) + term("D", "f", one, twice)
    total += term("e", "e", square, one) + term("f", "f", one, square)
    return np.asarray(2 * total + term("e", "f", twice, twice) - 8 * (width**2)[:, None, None, None])


def exactly_apart(legs, width):
    """Whether edges stay further apart than a width: the cube of places and times is halved until signs tell."""
    cubes, of, apart = squared_distance(legs, width), np.arange(len(width)), np.ones(len(width), dtype=bool)
    for depth in range(120):
        apart[of[(cubes[:, ::2, ::2, ::2] <= 0).any(axis=(1, 2, 3))]] = False
        left, axis = apart[of] & (cubes <= 0).any(axis=(1, 2, 3)), 1 + depth % 3
        a, b, c = np.moveaxis(cubes[left], axis, 0)
        middle = a + 2 * b + c
        halves = [4 * a, 2 * (a + b), middle], [middle, 2 * (b + c), 4 * c]  # all times 4
        cubes, of = np.concatenate([np.stack(half, axis=axis) for half in halves]), np.tile(of[left], 2)
    apart[of] = False  # they touch
    return apart


def random_legs(rng, kind, count):
    """Legs of pairs of edges with integers for coordinates, shape (2, legs, 4, 3), and widths about where they fail."""
    size = 3 if kind == "lattice" else 1 << 20
    legs = rng.integers(-size, size + 1, (2, count, 4, 3))
    if kind == "parallel":
        legs[:, :, 3] = legs[:, :, 2] + legs[:, :, 1] - legs[:, :, 0]
    if kind == "near":
        legs[1] = legs[0] + legs[1] // 4
    legs[:, :, 1::2] += (legs[:, :, 1::2] == legs[:, :, ::2]).all(axis=3, keepdims=True)  # no edge is a point
    mesh, best = Mesh((2,) * (2 * count), (False,) * (2 * count)), np.full(count, np.inf)
    i, j = np.arange(2 * count).reshape(-1, 2).T
    for t in np.linspace(0.0, 1.0, 65):
        pairs = EdgePairs.of(mesh, ((1 - t) * legs[0] + t * legs[1]).reshape(-1, 3), i, j)
        with np.errstate(invalid="ignore"):  # unless it turns round
            best = np.fmin(best, np.linalg.norm(closest(pairs)[0], axis=1))
    width = best * (1 + rng.choice([-0.3, -0.01, -1e-3, -1e-4, 0.0, 1e-4, 0.01], count))
    return legs.astype(object), np.maximum(np.rint(width), 1).astype(np.int64).astype(object)


@pytest.mark.parametrize("kind", ["gaussian", "near", "parallel", "lattice"])
def test_random_legs_against_an_exact_decision(kind):
    """None that comes nearer is proved, and of the others most are; the checker decides exactly, too."""
    legs, width = random_legs(np.random.default_rng(2027), kind, COUNT)
    exact, ends = exactly_apart(legs, width), legs.astype(float)
    found = np.array([is_rope(ARCS, *ends[:, k], np.full(2, 0.5 * width[k])) for k in range(COUNT)])
    assert not (found & ~exact).any()
    assert found.sum() >= 0.6 * exact.sum() > 0
    for k in range(20):
        moving = [(tuple(2 * legs[0, k, v]), tuple(2 * legs[1, k, v])) for v in range(4)]
        assert checker.stay_apart(moving[:2], moving[2:], 2 * width[k]) == exact[k]


@pytest.mark.parametrize("first", range(0, 24, 6))
@pytest.mark.parametrize("sizes", [(24, 24), (24, 8), (8, 24)])
def test_closed_components_never_pass_through_each_other(sizes, first):
    """Wherever numbers of vertices begin: rings that are unlinked by a motion, and the way back."""
    rings = [regular_polygon(n).vertices for n in sizes]
    start, end = (
        np.concatenate([np.roll(rings[0], first, axis=0), rings[1][:, [0, 2, 1]] + [shift, 0.01, 0.02]])
        for shift in (1.05, 2.5)
    )
    for ends in ((start, end), (end, start)):
        assert not is_rope(Mesh(sizes), *ends, np.full(2, 1e-4))
        assert is_rope(Mesh(sizes), ends[0], ends[0], np.full(2, 0.05))


@pytest.mark.parametrize(("name", "share"), [("3_1", 0.999), ("L6a4", 0.999), ("goeritz", 0.9)])
def test_thickness_is_the_largest_radius_of_smooth_curves(name, share):
    """But for sharp corners, where more than half of an edge may be an arc's, and more than half a circle is tested."""
    curve = knot(name, 200)
    thick = thickness(curve)
    radii = np.ones(len(curve.mesh.component_sizes))
    assert is_rope(curve.mesh, curve.vertices, curve.vertices, share * thick * radii)
    assert not is_rope(curve.mesh, curve.vertices, curve.vertices, 2.1 * thick * radii)


@pytest.mark.parametrize("away", [1e5, 1e9, 1e12])
def test_far_away_a_rope_is_one_all_the_same(away):
    """Where coordinates leave it its digits; differences that are rounded prove nothing."""
    curve, radius = knot("4_1", 100), np.array([1.0])
    there = np.rint(curve.vertices * 1e3) + away
    radius *= 950.0 * thickness(curve)
    assert is_rope(curve.mesh, there, there + 1.0, radius)
    assert not is_rope(curve.mesh, there, there + 1.0, 2.2 * radius)
    assert _lost(np.array([1.0]), np.array([1e-17]), np.array([1.0 - 1e-17])).any()


@pytest.mark.parametrize("edges", [4, 5, 24])
def test_regular_polygons(edges):
    """They are ropes up to the radius of their inscribed circle, which is that of all arcs at once."""
    polygon = regular_polygon(edges)
    inscribed = np.cos(np.pi / edges)
    for share, expected in ((0.99, True), (1.01, False)):
        found = is_rope(polygon.mesh, polygon.vertices, polygon.vertices, np.array([share * inscribed]))
        assert found is expected


@pytest.mark.parametrize("turn", [120.0, 160.0, 179.0])
def test_however_sharp_corners_are_those_of_ropes(turn):
    """Points of both edges that count are apart, though hardly."""
    theta = np.radians(turn)
    radius = 0.5 / np.tan(0.5 * theta)
    corner = np.array([[-1.0, 0.0], [0.0, 0.0], [np.cos(theta), np.sin(theta)]])
    assert is_rope(Mesh((3,), (False,)), corner, corner, np.array([radius]))
    a, b = np.meshgrid(*2 * [np.linspace(0.0, 1.0, 301)])
    apart = np.linalg.norm(a[..., None] * corner[0] - b[..., None] * corner[2], axis=2)
    assert 1.0 < apart[a + b >= 1.0 + (np.pi - theta) * radius].min() / (2.0 * radius) < 1.3


def test_a_motion_stops_where_strands_come_too_near():
    """Two parallel strands approach from a distance of 1 to none: ropes of .1 until it is .2."""
    t = np.linspace(0.0, 1.0, 11)
    start = [np.stack([t, 0 * t, np.full(11, z)], axis=1) for z in (0.0, 1.0)]
    curve = Curve.from_components(start, closed=(False, False))
    end = curve.vertices * [1.0, 1.0, 0.0]
    found = rope_motion(curve.mesh, curve.vertices, end, np.array([0.1, 0.1]))
    assert 0.75 < found.time <= 0.8
    assert not found.proved


@pytest.mark.parametrize("first", range(6))
def test_strands_behind_a_bend_are_near_wherever_vertices_are_counted_from(first):
    given = [[10.0, 0, 0], [0, 0, 0], [0, 1, 0.5], [10, -1, 0.5], [14, -6, 3], [14, 6, -3]]
    vertices = np.roll(given, first, axis=0)
    assert not is_rope(Mesh((6,), (True,)), vertices, vertices, np.array([0.3]))
    assert is_rope(Mesh((6,), (True,)), vertices, vertices, np.array([0.1]))


def test_nothing_is_proved_of_numbers_that_are_none():
    square = regular_polygon(4)
    lost = np.where(np.eye(4, 3) > 0, np.nan, square.vertices)
    for end, radius in ((square.vertices, np.nan), (square.vertices, np.inf), (lost, 0.1)):
        assert not is_rope(square.mesh, square.vertices, end, np.array([radius]))


def test_a_corner_gets_sharper():
    """A right angle with legs of 1 bends at radius ½; it is folded until its legs are parallel."""
    mesh = Mesh((3,), (False,))
    start = np.array([[1.0, 0, 0], [0, 0, 0], [0, 1.0, 0]])
    end = np.array([[1.0, 0, 0], [0, 0, 0], [1.0, 0.2, 0]])
    found = rope_motion(mesh, start, end, np.array([0.5]))
    assert 0.0 < found.time < 0.9
    assert is_rope(mesh, start, 0.9 * start + 0.1 * end, np.array([0.5]))
    assert not is_rope(mesh, start, start, np.array([1.01]))  # all of an edge, since its other end is straight


def test_an_obstacle_is_as_far_as_the_radius():
    wall = Obstacle([[-5.0, -5, 0], [5, -5, 0], [0, 9, 0]], [[0, 1, 2]])
    mesh = Mesh((2,), (False,))
    start, end = np.array([[0.0, 0, 1], [1, 0, 1]]), np.array([[0.0, 0, 0.5], [1, 0, 0.5]])
    assert is_rope(mesh, start, end, np.array([0.49]), [wall])
    found = rope_motion(mesh, start, end, np.array([0.6]), [wall])
    assert 0.7 < found.time <= 0.8
    assert found.contact.obstacle is not None


def test_ropes_are_free_of_contact():
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


def test_bounds_of_corners():
    rng = np.random.default_rng(11)
    e, f = (tuple(rng.standard_normal((2, 3, 500)) * 0.1 + [[[1.0]] * 3] * 2) for _ in range(2))
    low, high, _, _ = Corners(e, f).tangents()
    for t in np.linspace(0, 1, 21):
        u, v = ((1 - t) * each[0] + t * each[1] for each in (e, f))
        half = np.arctan2(np.linalg.norm(np.cross(u, v, axis=0), axis=0), np.sum(u * v, axis=0)) / 2
        assert (low <= np.tan(half)).all()
        assert (np.tan(half) <= high).all()


def test_what_arcs_save_is_not_overrated():
    x = np.linspace(0.0, 60.0, 600_001)
    exact = x - np.arctan(x)
    assert (shortcut(x) <= exact + 1e-15).all()
    assert (shortcut(x) >= exact - 0.03).all()


def test_what_arcs_save_on_the_way():
    """Each corner of a hexagon turns by 60°; those at the ends of arcs, and corners on the way that straighten, save
    none.
    """
    hexagon = regular_polygon(6)
    spans = [p.T[:, hexagon.mesh.heads] - p.T[:, hexagon.mesh.tails] for p in [hexagon.vertices] * 2]
    saved = _bends(hexagon.mesh, spans, np.full(6, 0.1))[2]
    np.testing.assert_allclose(saved, 0.1 * (2 * np.tan(np.pi / 6) - np.pi / 3), rtol=0.01)
    straight = [spans[0], np.tile([[1.0], [0.0], [0.0]], 6)]
    assert (_bends(hexagon.mesh, straight, np.full(6, 0.1))[2] < 0.2 * saved).all()


@pytest.mark.parametrize("radius", [0.05, 0.1])
def test_ropes_that_grow_stay_ropes(radius):
    """Edges that are half a circle apart at the end only, and near each other at the start."""
    drawn = knot("8_19").vertices
    start = np.stack([drawn, 0.5 * (drawn + np.roll(drawn, -1, axis=0))], axis=1).reshape(-1, 3)
    assert is_rope(Mesh((len(start),), (True,)), start, 2.0 * start, np.array([radius]))
