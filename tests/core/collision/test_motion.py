"""Free motions of whole curves."""

from itertools import pairwise

import numpy as np
import pytest
from exact_decisions import meet, until
from hypothesis import given, settings
from hypothesis import strategies as st
from mobius_flow.core import Curve, Mesh
from mobius_flow.core.collision import FreeMotion, Limit, free_motion, is_free
from shapes import hopf_link, regular_polygon, torus_trefoil


def smooth_displacement(curve: Curve, seed: int, waves: int = 8) -> np.ndarray:
    rng, n = np.random.default_rng(seed), len(curve)
    t = 2 * np.pi * np.arange(n) / n
    k = np.arange(1, waves)
    a, b = rng.normal(size=(2, waves - 1, curve.dimension)) / k[None, :, None]
    return np.cos(np.outer(t, k)) @ a + np.sin(np.outer(t, k)) @ b


def test_standing_still_is_free() -> None:
    curve = torus_trefoil(200)
    assert free_motion(curve.mesh, curve.vertices, curve.vertices) == FreeMotion(1.0, None, Limit.NONE)


@pytest.mark.parametrize("factor", [100.0, 1e-3])
def test_similarities_are_free(factor: float) -> None:
    curve = torus_trefoil(200)
    turned = curve.vertices[:, [1, 2, 0]]
    for end in (factor * curve.vertices, turned, factor * turned + 1e3):
        assert is_free(curve.mesh, curve.vertices, end)


def test_hopf_link_pulled_apart() -> None:
    """Two round circles through each other's centres: pulled apart, they meet after a radius."""
    link = hopf_link(100)
    end = link.vertices.copy()
    end[100:, 0] += 4.0
    motion = free_motion(link.mesh, link.vertices, end)
    # the second circle's leftmost vertex, at x = 0, meets the first circle's vertex at x = 1
    assert motion.limit is Limit.CONTACT
    assert 0.98 * 0.25 < motion.time < 0.25
    assert motion.contact is not None
    assert sorted(link.mesh.component[list(motion.contact.edges)].tolist()) == [0, 1]
    assert not is_free(link.mesh, link.vertices, end)
    assert is_free(link.mesh, link.vertices, link.vertices + motion.time * (end - link.vertices))


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("size", [0.03, 1.0, 30.0])
def test_time_is_confirmed_by_sampling(seed: int, size: float) -> None:
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


def volume(curve: Curve, points: np.ndarray, pair: tuple[int, int]) -> float:
    heads = curve.mesh.heads
    i, j = pair
    return float(
        np.linalg.det(np.stack([points[heads[i]] - points[i], points[heads[j]] - points[j], points[i] - points[j]]))
    )


@pytest.mark.parametrize("scale", [2.0**-20, 2.0**20, 2.0**-600, 2.0**900])
def test_units_do_not_matter(scale: float) -> None:
    curve = torus_trefoil(120)
    end = curve.vertices + smooth_displacement(curve, 3)
    expected = free_motion(curve.mesh, curve.vertices, end)
    assert free_motion(curve.mesh, scale * curve.vertices, scale * end) == expected


@pytest.mark.parametrize("offset", [1e3, 1e6])
def test_far_from_the_origin(offset: float) -> None:
    curve = torus_trefoil(120)
    end = curve.vertices + smooth_displacement(curve, 3)
    expected = free_motion(curve.mesh, curve.vertices, end)
    moved = free_motion(curve.mesh, curve.vertices + offset, end + offset)
    assert moved.contact == expected.contact
    assert moved.time == pytest.approx(expected.time, rel=0.02)


@given(st.integers(0, 10**6), st.sampled_from([2, 3]), st.sampled_from([(5,), (8,), (3, 4), (3, 3, 3)]))
@settings(max_examples=30, deadline=None, derandomize=True)
def test_earliest_contact_of_all_pairs(seed: int, m: int, sizes: tuple[int, ...]) -> None:
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


def test_touching_at_the_start() -> None:
    square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0.5, 0, 0], [0, 1, 0]])
    motion = free_motion(Mesh((5,)), square, square + np.array([0.0, 0.0, 1.0]))
    assert motion == FreeMotion(0.0, motion.contact, Limit.TOUCHING_START)
    assert not is_free(Mesh((5,)), square, square)


@pytest.mark.parametrize("gap", [1e-3, 1e-6, 1e-9, 1e-12])
def test_strands_that_slide_turn_and_stop_short(gap: float) -> None:
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


def test_folding_neighbours_are_noticed() -> None:
    """Neighbour edges are not tested; that they fold shows in the edges after them."""
    start = np.array([[0.0, 0, 0], [1, 0, 0], [1.5, 1, 0], [0.5, 2, 0.1], [-0.5, 1, 0]])
    end = start.copy()
    end[2] = [0.5, -1.0, 0.0]
    motion = free_motion(Mesh((5,)), start, end)
    assert motion.time == pytest.approx(0.5, rel=0.02)


def test_a_triangle_may_turn_over_but_not_collapse() -> None:
    triangle = np.array([[0.0, 0.0], [1.0, 0.0], [0.3, 1.0]])
    flipped = triangle * [1, -1]
    motion = free_motion(Mesh((3,)), triangle, flipped)
    assert 0.49 < motion.time < 0.5
    lifted = [np.concatenate([p, np.zeros((3, 1))], axis=1) for p in (triangle, flipped)]
    assert not is_free(Mesh((3,)), *lifted)
    upright = lifted[0][:, [0, 2, 1]]
    assert is_free(Mesh((3,)), lifted[0], upright)
    assert is_free(Mesh((3,)), upright, lifted[1])


def test_plane_curve_through_itself() -> None:
    curve = regular_polygon(60, dimension=2)
    start, end = curve.vertices, curve.vertices * [1.0, -1.0]
    motion = free_motion(curve.mesh, start, end)
    assert motion.limit is Limit.CONTACT
    assert 0.49 < motion.time < 0.5
    assert is_free(curve.mesh, start, 0.1 * start)


def test_not_finite_is_never_free() -> None:
    curve = regular_polygon(10)
    for bad in (np.nan, np.inf):
        end = curve.vertices.copy()
        end[3, 1] = bad
        assert free_motion(curve.mesh, curve.vertices, end) == FreeMotion(0.0, None, Limit.NOT_FINITE)
        assert not is_free(curve.mesh, end, curve.vertices)


def test_collapse_to_a_point() -> None:
    curve = torus_trefoil(100)
    motion = free_motion(curve.mesh, curve.vertices, 0 * curve.vertices)
    assert 0.98 < motion.time < 1
    still = free_motion(curve.mesh, 0 * curve.vertices, 0 * curve.vertices)
    assert (still.time, still.limit) == (0.0, Limit.TOUCHING_START)


def test_wrong_shapes_are_refused() -> None:
    mesh = Mesh((5,))
    for start, end in pairwise([np.zeros((5, 3)), np.zeros((5, 2)), np.zeros((4, 2)), np.zeros((4, 2))]):
        with pytest.raises(ValueError, match="must be"):
            free_motion(mesh, start, end)
    with pytest.raises(ValueError, match="must be"):
        is_free(mesh, np.zeros((5, 4)), np.zeros((5, 4)))


def test_thousands_of_components() -> None:
    rng = np.random.default_rng(11)
    places = np.stack(np.meshgrid(*3 * [np.arange(12.0)], indexing="ij"), axis=-1).reshape(-1, 1, 3)
    start = (places + rng.uniform(-0.4, 0.4, size=(len(places), 3, 3))).reshape(-1, 3)
    mesh = Mesh((3,) * len(places))
    assert is_free(mesh, start, 2 * start + 1)
    end = start.copy()
    end[:3] += [1.0, 0, 0]
    end[3 * 144 : 3 * 144 + 3] -= [1.0, 0, 0]
    motion = free_motion(mesh, start, end)
    if motion.contact is not None:
        assert {0, 144} & set(mesh.component[list(motion.contact.edges)].tolist())
