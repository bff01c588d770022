"""Places on objects, rotations that lay curves flat, planes of drawings, and sizes, whose change makes no contact."""

import numpy as np
import pytest
from mobius_flow.core import Curve, CurveError, RelaxOptions, relax
from mobius_flow.core.base.errors import Place
from mobius_flow.core.collision import is_rope
from mobius_flow.core.curve import refine
from mobius_flow.core.keys.key_options import Timing
from mobius_flow.core.keys.motion import Recording
from mobius_flow.core.keys.placement import Link, Measure, Placement, Similarity, at, framed, spots
from mobius_flow.core.keys.planes import DrawingPlane, Turn
from mobius_flow.core.keys.recording import Kind
from mobius_flow.core.knots import knot
from recorded_motions import around, assert_proved, at_rest, followed, iterate
from shapes import hopf_link, lattice_knot, regular_polygon, torus_trefoil

TRIANGLE = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
LINK = Curve.from_components([TRIANGLE, TRIANGLE + 5, TRIANGLE + 9])
OBJECTS = Link((Placement(np.eye(3), np.zeros(3)), Placement(2 * np.eye(3), np.array([5.0, 5.0, 5.0]))), (1, 2))


@pytest.mark.parametrize(
    ("vertices", "place", "found"),
    [
        ((4, 8), (6, 5, 5), [(1, [[0.5, 0, 0], [2, 2.5, 2]], [[0.5, 0, 0]])]),
        ((4, 1, 5), (5, 5, 7), [(1, [[0.5, 0, 0], [0, 0.5, 0]], [[0, 0, 1]]), (0, [[1, 0, 0]], np.empty((0, 3)))]),
        ((), (0.9, 0.2, 0), [(0, [[1, 0, 0]], [[0.9, 0.2, 0]])]),  # without vertices, at the nearest
    ],
    ids=["one object", "several", "none"],
)
def test_places_become_points_of_objects_in_their_own_coordinates(vertices, place, found):
    for spot, (member, points, marks) in zip(spots(Place(vertices, place), LINK, OBJECTS), found, strict=True):
        assert spot.member == member
        np.testing.assert_allclose(spot.points, points)
        np.testing.assert_allclose(spot.marks, marks)


@pytest.mark.parametrize(
    ("wanted", "found"),
    [([[0.0, 0, 0]], [0, 3]), ([[0.9, 0, 0]], [1]), ([[0, 1.1, 0], [0.9, 0, 0]], [1, 2]), ([[0.0, 0, 0.1]], [0, 3])],
)
def test_nearest_points_and_those_in_the_same_place(wanted, found):
    points = np.vstack([TRIANGLE, TRIANGLE[:1]])
    assert np.flatnonzero(at(points, np.array(wanted, dtype=float))).tolist() == found


TURNED = Placement(np.array([[0, -2, 0], [0.5, 0, 0.1], [0, 0, -3]]), np.array([100.0, -7, 3]))


def test_the_common_space_is_the_first_objects_and_objects_placed_alike_are_proved_in_their_own_numbers():
    curve = around(0.3)
    common = Link((TURNED, Placement(np.eye(3), np.array([1.0, 2, 3]))), (1, 1))
    stored = common.to_stored(curve.mesh, curve.vertices)
    np.testing.assert_allclose(TURNED.to_world(common.to_common(curve.mesh, stored)), curve.vertices, atol=1e-13)
    np.testing.assert_allclose(common.from_world(curve.vertices), common.to_common(curve.mesh, stored), atol=1e-13)
    for alike in (Link((TURNED, TURNED), (1, 1)), Link((TURNED,), (2,))):
        stored = alike.to_stored(curve.mesh, curve.vertices).astype(np.float32)
        assert np.array_equal(alike.to_common(curve.mesh, stored), stored)
        assert set(alike.scales) == {1.0}


ELLIPSE = regular_polygon(80).vertices * np.array([3.0, 1.0, 1.0]) + np.linspace(0, 0.1, 80)[:, None] ** 2


def rotation(seed):
    matrix, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return matrix * np.linalg.det(matrix)


@pytest.mark.parametrize("seed", range(4))
def test_a_turned_curve_has_the_wanted_axes(seed):
    curve, wanted = Curve(ELLIPSE @ rotation(seed) + 5.0), rotation(seed + 10)
    turn = Turn.onto(curve, wanted)
    homogeneous = np.pad(curve.vertices, ((0, 0), (0, 1)), constant_values=1.0)
    turned = Curve((homogeneous @ turn.matrix.T)[:, :3])
    assert np.linalg.det(turn.rotation) == pytest.approx(1.0)
    along = (turned.midpoints - turned.barycenter) @ wanted.T  # without products of inertia, the longest axis first
    inertia = (turned.edge_lengths[:, None] * along).T @ along
    np.testing.assert_allclose(inertia, np.diag(np.sort(np.diag(inertia))[::-1]), atol=1e-9)
    np.testing.assert_allclose(turned.barycenter, curve.barycenter, atol=1e-12)
    # a half turn about an axis leads to the same axes: none of them is nearer
    least = Turn.onto(curve, np.eye(3))
    for half in ((1, -1, -1), (-1, 1, -1), (-1, -1, 1)):
        assert np.trace(np.diag(half) @ least.rotation) <= np.trace(least.rotation) + 1e-12
    x, y, z = np.ptp(flat := (homogeneous @ least.matrix.T)[:, :3], axis=0)
    assert (x, y) == pytest.approx((6.0, 2.0), rel=0.02)
    assert z < 0.02
    np.testing.assert_allclose(Turn.onto(Curve(flat), np.eye(3)).rotation, np.eye(3), atol=1e-9)


def test_a_curve_is_turned_and_never_mirrored():
    """Also where its mirror image has axes much nearer to those that are wanted."""
    for seed in range(40):
        turn = Turn.onto(Curve(ELLIPSE @ rotation(seed)), rotation(seed + 100))
        assert np.linalg.det(turn.rotation) == pytest.approx(1.0)


@pytest.mark.parametrize("seed", range(4))
def test_drawings_are_flattened_and_raised_again_and_level_ones_keep_their_coordinates(seed):
    level = regular_polygon(30).with_vertices(regular_polygon(30).vertices + np.array([3, 4, 5]))
    plane = DrawingPlane.of(level)
    assert plane.flattened(level).vertices == pytest.approx(level.vertices[:, :2])
    assert plane.raised(np.array([[1.0, 2.0, 3.0]])) == pytest.approx(np.array([[1.0, 2.0, 8.0]]))
    with pytest.raises(CurveError, match="not flat"):
        DrawingPlane.of(torus_trefoil(40))
    curve = Curve(regular_polygon(30).vertices @ rotation(seed) + [1, 2, 3])
    plane = DrawingPlane.of(curve)
    flat = plane.flattened(curve).vertices
    assert plane.raised(np.column_stack([flat, np.zeros(30)])) == pytest.approx(curve.vertices)
    assert plane.axes @ plane.axes.T == pytest.approx(np.eye(3))
    assert np.linalg.det(plane.axes) == pytest.approx(1)
    assert plane.axes[2][abs(plane.axes[2]).argmax()] > 0


def given(size, curve, measure=Measure.LENGTH):
    return curve.with_vertices(Similarity.giving(measure, size, curve).of(curve.vertices))


CIRCLE = {Measure.LENGTH: 200 * 2 * np.sin(np.pi / 200), Measure.BOX: 2, Measure.RADIUS: 1}


@pytest.mark.parametrize("measure", Measure)
def test_sizes_scale_see_neither_places_nor_vertices_on_edges_and_can_be_given(measure):
    assert measure.of(regular_polygon(200)) == pytest.approx(CIRCLE[measure], rel=1e-3)
    big, small = torus_trefoil(40), hopf_link(30)
    moved = big.with_vertices(3.0 * big.vertices + np.array([1.0, -7.0, 5.0]))
    assert measure.of(moved) == pytest.approx(3.0 * measure.of(big))
    assert measure.of(refine(big, 70)) == pytest.approx(measure.of(big))
    same = given(measure.of(big), small, measure)
    assert measure.of(same) == pytest.approx(measure.of(big))
    np.testing.assert_allclose(same.barycenter, small.barycenter, atol=1e-12)
    own = Similarity.giving(measure, measure.of(big), big)
    assert own.of(big.vertices) is big.vertices  # bit for bit


def test_similarities_are_undone_and_follow_each_other_in_any_coordinates():
    point, one, other = np.array([1.0, 2.0, -3.0]), Similarity(0.5, np.array([3.0, 1, 0])), Similarity(3.0, np.ones(3))
    np.testing.assert_allclose(one.undone(one.of(point)), point)
    np.testing.assert_allclose(one.after(other).of(point), one.of(other.of(point)))
    local = TURNED.similarity(one)
    np.testing.assert_allclose(TURNED.to_world(local.of(point[None])), one.of(TURNED.to_world(point[None])))
    np.testing.assert_allclose(TURNED.in_world(local).shift, one.shift, atol=1e-12)


def test_the_motion_between_scaled_keys_is_the_old_one_at_another_pace():
    """(1 − t) a A + t b B is a multiple of (1 − u) A + u B; both about their barycenters, up to a translation."""
    a, b = torus_trefoil(30), torus_trefoil(30).with_vertices(torus_trefoil(30).vertices[:, [1, 2, 0]] + 4.0)
    small, large = given(5.0, a), given(300.0, b)
    factors = 5.0 / a.length, 300.0 / b.length
    for t in (0.1, 0.5, 0.93):
        middle = (1 - t) * small.vertices + t * large.vertices
        scale = (1 - t) * factors[0] + t * factors[1]
        u = t * factors[1] / scale
        away = middle - scale * ((1 - u) * a.vertices + u * b.vertices)
        np.testing.assert_allclose(away, np.broadcast_to(away[0], away.shape), atol=1e-9)


@pytest.mark.parametrize("in_points", [False, True])
@pytest.mark.parametrize("measure", [Measure.BOX, Measure.RADIUS])
def test_a_motion_is_shown_in_one_size_and_its_keys_are_the_iterates(measure, in_points):
    iterates = list(relax(lattice_knot("4_1"), RelaxOptions(max_iterations=6, vertices=90, mesh="fixed")))
    motion = followed(iterates, measure=measure, in_points=in_points)
    keys = motion.keys(is_rope, None, Timing(length=100))
    assert_proved(keys, motion.start.mesh)
    shown = [Curve(key.size.of(key.points.astype(float))) for key in keys.keys]
    size = measure.of(iterates[0].curve)
    np.testing.assert_allclose([measure.of(curve) for curve in shown], size, rtol=0.02)
    for key, curve in zip(keys.keys, shown, strict=True):
        if key.kind is Kind.STEP:
            each = iterates[int(key.time)].curve
            assert measure.of(curve) == pytest.approx(size, rel=1e-6)
            np.testing.assert_allclose(curve.barycenter, each.barycenter, atol=1e-5)
            assert in_points or np.array_equal(key.points, each.vertices.astype(np.float32))
    assert in_points == all(key.size.is_identity for key in keys.keys)
    np.testing.assert_allclose(motion.shown.points, shown[-1].vertices, atol=1e-6)


@pytest.mark.parametrize(
    ("sizes", "pins", "natural", "shown"),
    [
        ((1, 5, 7, 6, 4), 5 * [()], [0, 4], 4.0 ** np.linspace(0, 1, 5)),
        ((1, 2, 3, 4, 4), [(), (), (0,), (0,), ()], [0], [1, 1, 1.5, 2, 1]),
    ],
    ids=["goals have their own size where they are reached", "what a hand has pinned stays where it is seen"],
)
def test_sizes_change_evenly_between_curves_that_have_their_own(sizes, pins, natural, shown):
    ring = regular_polygon(20)
    motion = Recording(at_rest(1), measure=Measure.RADIUS)
    for k, (size, held) in enumerate(zip(sizes, pins, strict=True)):
        motion.add(iterate(k, size * ring.vertices, ring, pins=held))
    motion.natural = natural
    seen = [np.linalg.norm(key.size.of(key.points.astype(float))[5]) for key in motion.keys(is_rope).keys]
    np.testing.assert_allclose(seen, shown, rtol=1e-6)


def test_pictures_are_made_around_the_knot_of_a_rope_and_not_around_its_ends():
    def arc(vertices):
        return Curve.from_components([vertices], [False])

    rope = knot("overhand", 60)
    ends = rope.vertices[[0, -1]] + 30.0 * (rope.vertices[[0, -1]] - rope.vertices[[1, -2]])
    longer = arc(np.concatenate([ends[:1], rope.vertices, ends[1:]]))
    seen, size = framed(longer), np.linalg.norm(np.ptp(rope.vertices, axis=0))
    assert np.linalg.norm(np.ptp(longer.vertices, axis=0)) > 2.5 * size > 2.0 * np.linalg.norm(np.ptp(seen, axis=0))
    np.testing.assert_array_equal(seen[20:40], longer.vertices[20:40])
    bent = np.array([[-9.0, 0, 0], [0, 0, 0], [0, 1, 0], [9, 1, 0]])
    corner = np.concatenate([np.linspace([0.0, 9, 0], [0.0, 0.5, 0.0], 20), np.linspace([0.0, 0, 0], [9, 0, 0], 20)])
    x = np.arange(-60.0, 11.0)
    needle = np.stack(
        [np.append(x, x[::-1]), np.append(-1.0 - 0.01 * x**2, 1.0 + 0.01 * x[::-1] ** 2), 0 * np.append(x, x)], axis=1
    )
    cables = Curve.from_components([np.stack([x, 0 * x, 0 * x], 1), np.stack([0 * x, x, 1 + 0 * x], 1)], [False, False])
    for whole in (cables, *map(arc, (bent, bent[[0, 1, 3]] * [1, 0, 0], corner, needle)), torus_trefoil(60)):
        np.testing.assert_array_equal(framed(whole), whole.vertices)
