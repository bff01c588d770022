"""Motions that are proved free of contact, and ways in several of them."""

from itertools import pairwise

import numpy as np
import pytest
from exact_decisions import meet, until
from hypothesis import given, settings
from hypothesis import strategies as st
from mobius_flow.core import Mesh
from mobius_flow.core.collision import FreeMotion, free_motion, is_free
from mobius_flow.core.collision.motion import walk
from shapes import hopf_link, regular_polygon, torus_trefoil


def smooth_displacement(curve, seed, waves=8):
    rng, n = np.random.default_rng(seed), len(curve)
    t = 2 * np.pi * np.arange(n) / n
    k = np.arange(1, waves)
    a, b = rng.normal(size=(2, waves - 1, curve.dimension)) / k[None, :, None]
    return np.cos(np.outer(t, k)) @ a + np.sin(np.outer(t, k)) @ b


@pytest.mark.parametrize("factor", [100.0, 1e-3])
def test_similarities_are_free(factor):
    curve = torus_trefoil(200)
    turned = curve.vertices[:, [1, 2, 0]]
    for end in (factor * curve.vertices, turned, factor * turned + 1e3):
        assert is_free(curve.mesh, curve.vertices, end)


def test_hopf_link_pulled_apart():
    """Two round circles through each other's centres: pulled apart, they meet after a radius."""
    link = hopf_link(100)
    end = link.vertices.copy()
    end[100:, 0] += 4.0
    motion = free_motion(link.mesh, link.vertices, end)
    # the second circle's leftmost vertex, at x = 0, meets the first circle's vertex at x = 1
    assert not motion.proved
    assert 0.98 * 0.25 < motion.time < 0.25
    assert sorted(link.mesh.component[list(motion.contact.edges)].tolist()) == [0, 1]
    assert not is_free(link.mesh, link.vertices, end)
    assert is_free(link.mesh, link.vertices, link.vertices + motion.time * (end - link.vertices))


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("size", [0.03, 1.0, 30.0])
def test_time_is_confirmed_by_sampling(seed, size):
    """Just before the time all edges are apart; a little after it, the pair named has gone through itself."""
    curve = torus_trefoil(240)
    start, step = curve.vertices, size * smooth_displacement(curve, seed)
    motion = free_motion(curve.mesh, start, start + step)
    if motion.contact is None:
        assert motion.time == 1.0
        return
    assert 0 < motion.time < 1
    volumes = [volume(curve, start + f * motion.time * step, motion.contact.edges) for f in (1 - 1e-9, 1.021)]
    assert volumes[0] * volumes[1] < 0
    assert is_free(curve.mesh, start, start + (1 - 1e-9) * motion.time * step)


def volume(curve, points, pair):
    heads = curve.mesh.heads
    i, j = pair
    return float(
        np.linalg.det(np.stack([points[heads[i]] - points[i], points[heads[j]] - points[j], points[i] - points[j]]))
    )


def test_units_do_not_matter_nor_much_the_distance_from_the_origin():
    curve = torus_trefoil(120)
    end = curve.vertices + smooth_displacement(curve, 3)
    expected = free_motion(curve.mesh, curve.vertices, end)
    for scale in (2.0**-20, 2.0**20, 2.0**-600, 2.0**900):
        assert free_motion(curve.mesh, scale * curve.vertices, scale * end) == expected
    for offset in (1e3, 1e6):
        moved = free_motion(curve.mesh, curve.vertices + offset, end + offset)
        assert moved.contact == expected.contact
        assert moved.time == pytest.approx(expected.time, rel=0.02)


@given(st.integers(0, 10**6), st.sampled_from([2, 3]), st.sampled_from([(5,), (8,), (3, 4), (3, 3, 3)]))
@settings(max_examples=30, deadline=None, derandomize=True)
def test_earliest_contact_of_all_pairs(seed, m, sizes):
    mesh, rng = Mesh(sizes), np.random.default_rng(seed)
    start = np.concatenate([rng.normal(size=(k, m)) + 3 * c for c, k in enumerate(sizes)])
    end = start + rng.choice([0.1, 1.0]) * rng.normal(size=start.shape)
    i, j = np.triu_indices(mesh.size, 1)
    i, j = i[mesh.disjoint(i, j)], j[mesh.disjoint(i, j)]
    quadruples = np.stack([i, mesh.heads[i], j, mesh.heads[j]], axis=1)
    motion = free_motion(mesh, start, end)
    assert motion.time == 0 or not any(until(meet, start[four], end[four], motion.time) for four in quadruples)
    if motion.contact is None:
        assert motion == FreeMotion(1.0)
    elif mesh.disjoint(*motion.contact.edges):  # no triangle that turns inside out
        later = min(1.0, motion.time / 0.98)
        assert any(until(meet, start[four], end[four], later) for four in quadruples)


@pytest.mark.parametrize("gap", [1e-3, 1e-6, 1e-9, 1e-12])
def test_strands_that_slide_turn_and_stop_short(gap):
    x = np.linspace(0, 1, 30)
    strands = np.array([[a, 0, 0] for a in x] + [[a, gap, 0] for a in x[::-1]])
    mesh = Mesh((60,))
    apart = strands + [0, 1, 0] * (np.arange(60) >= 30)[:, None]
    assert is_free(mesh, apart, strands)
    sliding = strands + np.where(np.arange(60) < 30, 0.25, -0.25)[:, None] * [1, 0, 0]
    assert is_free(mesh, strands, sliding)
    turn = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    assert is_free(mesh, strands, strands @ turn * np.sign(np.linalg.det(turn)))
    through = strands * [1, -1, 1]
    motion = free_motion(mesh, apart, through)
    contact = 1 / (1 + 2 * gap) if gap > 0 else 1.0
    assert motion.time == pytest.approx(contact * (1 + gap), rel=0.02)


FOLDING = np.array([[0.0, 0, 0], [1, 0, 0], [1.5, 1, 0], [0.5, 2, 0.1], [-0.5, 1, 0]])
TRIANGLE = np.array([[0.0, 0.0], [1.0, 0.0], [0.3, 1.0]])
FLAT = np.column_stack([TRIANGLE, np.zeros(3)])
CIRCLE = regular_polygon(60, dimension=2).vertices
KNOT = torus_trefoil(100).vertices
TOUCHING = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0.5, 0, 0], [0, 1, 0]])


@pytest.mark.parametrize(
    ("start", "end", "contact"),
    [
        (FOLDING, np.concatenate([FOLDING[:2], [[0.5, -1, 0]], FOLDING[3:]]), 0.5),  # noticed by the edges after them
        (TRIANGLE, TRIANGLE * [1, -1], 0.5),
        (FLAT, FLAT * [1, -1, 1], 0.5),
        (FLAT, FLAT[:, [0, 2, 1]], None),  # in space it may turn over
        (FLAT[:, [0, 2, 1]], FLAT * [1, -1, 1], None),
        (CIRCLE, CIRCLE * [1, -1], 0.5),
        (CIRCLE, 0.1 * CIRCLE, None),
        (KNOT, KNOT, None),
        (KNOT, 0 * KNOT, 1.0),
        (0 * KNOT, 0 * KNOT, 0.0),
        (TOUCHING, TOUCHING + np.eye(3)[2], 0.0),
        (TOUCHING, TOUCHING, 0.0),
    ],
)
def test_contacts_known_by_hand(start, end, contact):
    mesh = Mesh((len(start),))
    motion = free_motion(mesh, start, end)
    assert is_free(mesh, start, end) == (contact is None)
    if contact is None:
        assert motion == FreeMotion(1.0)
    elif contact == 0:
        assert motion == FreeMotion(0.0, motion.contact, proved=False)
        assert motion.contact is not None
    else:
        assert not motion.proved
        assert 0.98 * contact <= motion.time < contact


def test_not_finite_is_never_free():
    for bad in (np.nan, np.inf):
        end = CIRCLE.copy()
        end[3, 1] = bad
        assert free_motion(Mesh((60,)), CIRCLE, end) == FreeMotion(0.0, None, proved=False)
        assert not is_free(Mesh((60,)), end, CIRCLE)


def test_thousands_of_components():
    rng = np.random.default_rng(11)
    places = np.stack(np.meshgrid(*3 * [np.arange(12.0)], indexing="ij"), axis=-1).reshape(-1, 1, 3)
    start = (places + rng.uniform(-0.4, 0.4, size=(len(places), 3, 3))).reshape(-1, 3)
    assert is_free(Mesh((3,) * len(places)), start, 2 * start + 1)


@given(end=st.floats(0.01, 50.0), longest=st.floats(0.01, 5.0), seed=st.randoms())
def test_a_walk_is_an_unbroken_chain_of_proved_legs(end, longest, seed):
    asked = []

    def leg(place, stride):
        asked.append((place, stride, seed.random() < 0.7))
        return "proved" if asked[-1][2] else None

    legs = list(walk(leg, end, longest, 1e-3 * longest))
    ways = [(place, stride) for place, stride, free in asked if free]
    assert [place for place, _ in legs] == [place + stride for place, stride in ways]
    assert [place for place, _ in ways[1:]] == [place for place, _ in legs[:-1]]
    for (_, before, free), (_, stride, _) in pairwise(asked):
        assert stride == (min(2.0 * before, longest) if free else 0.5 * before)


@pytest.mark.parametrize(("shortest", "tried"), [(1.0, 1), (0.5, 2), (0.3, 2), (0.1, 4)])
def test_strides_shorter_than_the_shortest_are_not_tried(shortest, tried):
    strides = []
    assert list(walk(lambda _, stride: strides.append(stride), 1.0, 1.0, shortest)) == []
    assert strides == [0.5**k for k in range(tried)]
