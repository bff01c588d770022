"""Boxes around moving edges, and the time until which a search looks for contacts."""

import os
from fractions import Fraction

import numpy as np
import pytest
from degenerate_motions import ARCS, tied_windows
from mobius_flow.core import Mesh
from mobius_flow.core.collision import is_free
from mobius_flow.core.collision.boxes import BoxTree, contact_window, still_triangles
from solids import sphere

MESHES = [Mesh((3,)), Mesh((4,)), Mesh((100,)), Mesh((3, 3)), Mesh((7, 3, 31)), Mesh((3,) * 40), Mesh((257, 4, 64))]


def random_leg(mesh, m, seed=5):
    rng = np.random.default_rng(seed)
    start = rng.uniform(-1, 1, size=(m, mesh.size)) * rng.choice([0.1, 1.0], size=(1, mesh.size))
    return start, np.clip(start + 0.3 * rng.normal(size=start.shape), -1, 1)


def found(tree, near):
    pairs = [np.sort(tree.order[np.stack(p)], axis=0).T for p in tree.pairs(near)]
    return [(int(i), int(j)) for i, j in np.concatenate(pairs)]


def strangers(mesh):
    i, j = np.triu_indices(mesh.size, 1)
    apart = mesh.disjoint(i, j)
    return set(zip(i[apart].tolist(), j[apart].tolist(), strict=True))


@pytest.mark.parametrize("chunk", [5, 1 << 14])
@pytest.mark.parametrize("mesh", MESHES, ids=str)
def test_every_pair_exactly_once(mesh, chunk, monkeypatch):
    monkeypatch.setattr(BoxTree, "chunk", chunk)
    tree = BoxTree.build(mesh, *random_leg(mesh, 3))
    pairs = found(tree, lambda level, a, other, b: np.ones(len(a), dtype=bool))
    assert len(pairs) == len(set(pairs))
    assert set(pairs) == strangers(mesh)


@pytest.mark.parametrize("n", [3, 40, 200])
def test_every_pair_of_edge_and_triangle_exactly_once(n):
    still, mesh = still_triangles((sphere(1.0),), 1), Mesh((n,))
    tree = BoxTree.build(mesh, *random_leg(mesh, 3))
    pairs = [
        (int(i), int(j))
        for a, b in tree.pairs_with(still.tree, lambda level, a, other, b: np.ones(len(a), dtype=bool))
        for i, j in zip(tree.order[a], still.tree.order[b], strict=True)
    ]
    assert len(pairs) == len(set(pairs)) == n * len(still.tree.order)


@pytest.mark.parametrize("m", [2, 3])
@pytest.mark.parametrize("mesh", MESHES, ids=str)
def test_no_pair_that_can_meet_is_lost(mesh, m):
    start, end = random_leg(mesh, m)
    tree = BoxTree.build(mesh, start, end)

    def near(level, a, other, b):
        enter, leave = contact_window(level.gaps(a, other, b))
        return np.asarray(enter <= leave)

    assert set(found(tree, near)) >= overlapping(mesh, start, end)


def overlapping(mesh, start, end):
    """Pairs of edges whose bounding boxes overlap at one of many times, by brute force."""
    pairs = set()
    for t in np.linspace(0, 1, 21):
        p = (1 - t) * start + t * end
        q = p[:, mesh.heads]
        low, high = np.minimum(p, q), np.maximum(p, q)
        meet = (low[:, :, None] <= high[:, None]) & (low[:, None] <= high[:, :, None])
        pairs |= set(zip(*(k.tolist() for k in np.nonzero(meet.all(axis=0))), strict=True))
    return pairs & strangers(mesh)


def test_contact_window():
    # one row per ± axis, one column per pair of boxes; gaps at the start and at the end
    before = np.array([[1.0, 1.0, -1.0, -1.0, 0.0], [-3.0, -1.0, -1.0, -1.0, -1.0]])
    after = np.array([[-1.0, 2.0, -1.0, 3.0, 0.0], [1.0, -1.0, -1.0, -1.0, -1.0]])
    enter, leave = contact_window(np.stack([before, after]))
    np.testing.assert_allclose(enter, [0.5, np.inf, 0.0, 0.0, 0.0], rtol=1e-12)
    np.testing.assert_allclose(leave, [0.75, 1.0, 1.0, 0.25, 1.0], rtol=1e-12)


COUNT = int(os.environ.get("MOBIUS_FLOW_MOTIONS", "200"))
TWO_ARCS = Mesh((2, 2), (False, False))


def exact_window(before, after):
    """When no gap is positive, of gaps that are linear in time; None if never."""
    enter, leave = Fraction(0), Fraction(1)
    for a, b in zip(map(Fraction, before), map(Fraction, after), strict=True):
        if a > 0 and b > 0:
            return None
        if a > 0:
            enter = max(enter, a / (a - b))
        elif b > 0:
            leave = min(leave, a / (a - b))
    return (enter, leave) if enter <= leave else None


def test_windows_are_never_too_narrow():
    """Roots are rounded, but boxes that touch for a moment only are found."""
    rng = np.random.default_rng(41)
    gaps = rng.uniform(-1.0, 1.0, size=(2, 2, 400))
    gaps[:, 1] = -gaps[:, 0]  # one gap opens as another one closes: at the same time
    enter, leave = contact_window(gaps)
    found = 0
    for k in range(gaps.shape[2]):
        window = exact_window(gaps[0, :, k].tolist(), gaps[1, :, k].tolist())
        if window is not None:
            found += 1
            assert Fraction(enter[k]) <= window[0] <= window[1] <= Fraction(leave[k])
    assert found > 50


def test_larger_boxes_meet_no_later_and_part_no_earlier():
    """To the last bit, or a search that is split at a time may find a pair in neither part."""
    rng = np.random.default_rng(43)
    gaps = rng.choice([-1.0, 1.0], size=(2, 1, 40_000)) * 2.0 ** rng.uniform(-3, 0, size=(2, 1, 40_000))
    gaps[rng.random(gaps.shape) < 0.01] = 0.0
    larger = gaps - rng.integers(0, 3, size=gaps.shape) * np.spacing(np.abs(gaps))
    enter, leave = contact_window(gaps)
    first, last = contact_window(larger)
    assert (first <= enter).all()
    assert (leave <= last).all()


def test_no_crossing_slips_through_where_the_search_is_split():
    rng, mesh = np.random.default_rng(47), Mesh((2,) * ARCS, (False,) * ARCS)
    assert sum(is_free(mesh, *tied_windows(rng)) for _ in range(COUNT)) == 0


def test_digits_that_scaling_costs_hide_no_crossing():
    """An arc passes another one in so short a time that their distances are numbers without all their digits."""
    unit = 2.0**-1074
    still = np.array([[0.0, 0.0, -1024.0], [0.0, 0.0, 1024.0]])
    # x from and to, and y of the upper end from and to, which is still positive when x vanishes
    for motion in ((1100, -2600, 900, -1500), (1100, -2700, 1000, -1900), (1100, -1024 / unit, 600, -512 / unit)):
        before, after, high, low = unit * np.array(motion)
        start, end = [[before, -600.0, 0.0], [before, high, 0.0]], [[after, -1000.0, 0.0], [after, low, 0.0]]
        assert not is_free(TWO_ARCS, np.concatenate([still, start]), np.concatenate([still, end]))
