"""Keys that are scaled so that a curve's size stays, and why that makes no contact."""

import numpy as np
import pytest
from mobius_flow.core import Curve, RelaxOptions, relax
from mobius_flow.core.collision import free_motion, is_free
from mobius_flow.core.curve import refine
from mobius_flow.core.keys.key_options import Timing
from mobius_flow.core.keys.motion import Kind, Recording
from mobius_flow.core.keys.placement import Measure, Placement, Similarity, barycenter
from recorded_motions import assert_proved, at_rest, iterate
from shapes import hopf_link, lattice_knot, regular_polygon, torus_trefoil


def rings():
    """Two linked rings, and where the second one has gone a little way, or out of the first one."""
    curve = hopf_link(30)
    ends = [np.concatenate([curve.vertices[:30], curve.vertices[30:] + np.array([x, 0.1, 0.0])]) for x in (0.4, 3.0)]
    return curve, *(curve.with_vertices(end) for end in ends)


@pytest.mark.parametrize(("measure", "value"), [("LENGTH", 200 * 2 * np.sin(np.pi / 200)), ("BOX", 2), ("RADIUS", 1)])
def test_sizes_of_a_circle(measure, value):
    assert Measure[measure].of(regular_polygon(200)) == pytest.approx(value, rel=1e-3)


@pytest.mark.parametrize("measure", Measure)
def test_sizes_are_lengths_and_do_not_see_places(measure):
    curve = torus_trefoil(40)
    moved = curve.with_vertices(3.0 * curve.vertices + np.array([1.0, -7.0, 5.0]))
    assert measure.of(moved) == pytest.approx(3.0 * measure.of(curve))


@pytest.mark.parametrize("measure", Measure)
def test_vertices_on_edges_change_no_size(measure):
    curve = torus_trefoil(20)
    assert measure.of(refine(curve, 70)) == pytest.approx(measure.of(curve))


def given(size, curve, measure=Measure.LENGTH):
    return curve.with_vertices(Similarity.giving(measure, size, curve).of(curve.vertices))


@pytest.mark.parametrize("measure", Measure)
def test_a_size_is_given_and_the_barycenter_stays(measure):
    big, small = torus_trefoil(40), hopf_link(30)
    same = given(measure.of(big), small, measure)
    assert measure.of(same) == pytest.approx(measure.of(big))
    np.testing.assert_allclose(barycenter(same), barycenter(small), atol=1e-12)


def test_what_has_the_size_stays_bit_for_bit():
    curve = torus_trefoil(40)
    size = Similarity.giving(Measure.BOX, Measure.BOX.of(curve), curve)
    assert size.of(curve.vertices) is curve.vertices


def test_similarities_are_undone_and_follow_each_other_in_any_coordinates():
    point, one, other = np.array([1.0, 2.0, -3.0]), Similarity(0.5, np.array([3.0, 1, 0])), Similarity(3.0, np.ones(3))
    np.testing.assert_allclose(one.undone(one.of(point)), point)
    np.testing.assert_allclose(one.after(other).of(point), one.of(other.of(point)))
    place = Placement(np.array([[0.0, -2.0, 0.3], [0.5, 0.0, 0.0], [0.0, 0.1, 1.0]]), np.array([1.0, 2.0, 3.0]))
    local = place.similarity(one)
    np.testing.assert_allclose(place.to_world(local.of(point[None])), one.of(place.to_world(point[None])))
    np.testing.assert_allclose(place.in_world(local).shift, one.shift, atol=1e-12)


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


@pytest.mark.parametrize("sizes", [(1.0, 1.0), (1e-3, 1.0), (1.0, 700.0)])
def test_contact_is_neither_made_nor_undone(sizes):
    curve, free, touching = rings()
    for end, expected in ((free, True), (touching, False)):
        start, stop = (given(s, c) for s, c in zip(sizes, (curve, end), strict=True))
        assert is_free(curve.mesh, start.vertices, stop.vertices) is expected


def test_the_time_of_contact_is_passed_at_the_other_pace():
    curve, _, touching = rings()
    t = free_motion(curve.mesh, curve.vertices, touching.vertices).time
    u = free_motion(curve.mesh, curve.vertices, given(10 * touching.length, touching).vertices).time
    assert u == pytest.approx(t / (t + 10.0 * (1 - t)), rel=0.05)


@pytest.mark.parametrize("in_points", [False, True])
@pytest.mark.parametrize("measure", [Measure.BOX, Measure.RADIUS])
def test_a_motion_is_shown_in_one_size_and_its_keys_are_the_iterates(measure, in_points):
    iterates = list(relax(lattice_knot("4_1"), RelaxOptions(max_iterations=6, vertices=90, mesh="fixed")))
    motion = Recording(at_rest(1), measure=measure, in_points=in_points)
    for each in iterates:
        motion.add(each)
    keys = motion.keys(is_free, None, Timing(length=100))
    assert_proved(keys, motion.start.mesh)
    shown = [Curve(key.size.of(key.points.astype(float))) for key in keys.keys]
    size = measure.of(iterates[0].curve)
    np.testing.assert_allclose([measure.of(curve) for curve in shown], size, rtol=0.02)
    for key, curve in zip(keys.keys, shown, strict=True):
        if key.kind is Kind.STEP:
            each = iterates[int(key.time)].curve
            assert measure.of(curve) == pytest.approx(size, rel=1e-6)
            np.testing.assert_allclose(barycenter(curve), barycenter(each), atol=1e-5)
            assert in_points or np.array_equal(key.points, each.vertices.astype(np.float32))
    assert in_points == all(key.size.is_identity for key in keys.keys)
    np.testing.assert_allclose(motion.frame, shown[-1].vertices, atol=1e-6)


def test_sizes_change_evenly_between_curves_that_have_their_own():
    """Goals: a curve that is large on its way is not shown so, and has its own size where it arrives."""
    ring = regular_polygon(20)
    sizes = [1.0, 5.0, 7.0, 6.0, 4.0]
    motion = Recording(at_rest(1), measure=Measure.RADIUS)
    for k, size in enumerate(sizes):
        motion.add(iterate(k, size * ring.vertices, ring))
    motion.natural = [0, 4]
    keys = motion.keys(is_free)
    shown = [np.linalg.norm(key.size.of(key.points.astype(float))[0]) for key in keys.keys]
    np.testing.assert_allclose(shown, 4.0 ** np.linspace(0, 1, 5), rtol=1e-6)


def test_what_a_hand_has_pinned_stays_where_it_is_seen():
    ring = regular_polygon(20)
    motion = Recording(at_rest(1), measure=Measure.RADIUS)
    for k, (size, pins) in enumerate([(1.0, ()), (2.0, ()), (3.0, (0,)), (4.0, (0,)), (4.0, ())]):
        motion.add(iterate(k, size * ring.vertices, ring, pins=pins))
    factors = [key.size.factor for key in motion.keys(is_free).keys]
    np.testing.assert_allclose(factors, [1.0, 0.5, 0.5, 0.5, 0.25], rtol=1e-6)
