"""Keys that are scaled so that a curve's size stays, and why that makes no contact."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from mobius_flow.addon.engine.size import Measure, Size, barycenter
from mobius_flow.core import RelaxOptions, relax
from mobius_flow.core.collision import free_motion, is_free
from mobius_flow.core.curve import refine
from shapes import hopf_link, regular_polygon, torus_trefoil


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


@pytest.mark.parametrize("measure", Measure)
def test_a_size_is_given_and_the_barycenter_stays(measure):
    big, small = torus_trefoil(40), hopf_link(30)
    given = Size.of(measure, big).given_to(small)
    assert measure.of(given) == pytest.approx(measure.of(big))
    np.testing.assert_allclose(barycenter(given), barycenter(small), atol=1e-12)


def test_what_has_the_size_stays_bit_for_bit():
    curve = torus_trefoil(40)
    assert Size.of(Measure.BOX, curve).given_to(curve) is curve


def test_the_motion_between_scaled_keys_is_the_old_one_at_another_pace():
    """(1 − t) a A + t b B is a multiple of (1 − u) A + u B; both about their barycenters, up to a translation."""
    a, b = torus_trefoil(30), torus_trefoil(30).with_vertices(torus_trefoil(30).vertices[:, [1, 2, 0]] + 4.0)
    small, large = Size(Measure.LENGTH, 5.0).given_to(a), Size(Measure.LENGTH, 300.0).given_to(b)
    factors = 5.0 / a.length, 300.0 / b.length
    for t in (0.1, 0.5, 0.93):
        middle = (1 - t) * small.vertices + t * large.vertices
        scale = (1 - t) * factors[0] + t * factors[1]
        u = t * factors[1] / scale
        old = scale * ((1 - u) * a.vertices + u * b.vertices)
        away = middle - old
        np.testing.assert_allclose(away, np.broadcast_to(away[0], away.shape), atol=1e-9)


@pytest.mark.parametrize("sizes", [(1.0, 1.0), (1e-3, 1.0), (1.0, 700.0)])
def test_contact_is_neither_made_nor_undone(sizes):
    curve, free, touching = rings()
    for end, expected in ((free, True), (touching, False)):
        start, stop = (Size(Measure.LENGTH, s).given_to(c) for s, c in zip(sizes, (curve, end), strict=True))
        assert is_free(curve.mesh, start.vertices, stop.vertices) is expected


def test_the_time_of_contact_is_passed_at_the_other_pace():
    curve, _, touching = rings()
    t = free_motion(curve.mesh, curve.vertices, touching.vertices).time
    large = Size(Measure.LENGTH, 10 * touching.length).given_to(touching)
    factor = 10.0
    u = free_motion(curve.mesh, curve.vertices, large.vertices).time
    assert u == pytest.approx(t / (t + factor * (1 - t)), rel=0.05)


def test_iterates_are_scaled_leg_by_leg():
    *_, iterate = relax(torus_trefoil(60), RelaxOptions(max_iterations=3, vertices=60))
    way = (iterate.curve.vertices + 0.01, iterate.curve.vertices)
    scaled = Size(Measure.BOX, 7.0).given_to_iterate(replace(iterate, path=way))
    assert np.array_equal(scaled.path[-1], scaled.curve.vertices)
    for end in (*scaled.path, scaled.curve.vertices):
        assert np.ptp(end, axis=0).max() == pytest.approx(7.0)
    assert all(is_free(iterate.curve.mesh, a, b) for a, b in pairwise(scaled.path))
