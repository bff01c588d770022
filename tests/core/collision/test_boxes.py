"""The tree of moving boxes: it meets every pair of edges once and loses none that can come together."""

import numpy as np
import pytest
from mobius_flow.core import Mesh
from mobius_flow.core.base.types import BoolArray, IntArray
from mobius_flow.core.collision import boxes
from mobius_flow.core.collision.boxes import BoxTree, Level, contact_window, still_triangles
from solids import sphere

MESHES = [Mesh((3,)), Mesh((4,)), Mesh((100,)), Mesh((3, 3)), Mesh((7, 3, 31)), Mesh((3,) * 40), Mesh((257, 4, 64))]


def random_leg(mesh: Mesh, m: int, seed: int = 5) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    start = rng.uniform(-1, 1, size=(m, mesh.size)) * rng.choice([0.1, 1.0], size=(1, mesh.size))
    return start, np.clip(start + 0.3 * rng.normal(size=start.shape), -1, 1)


def found(tree: BoxTree, near: boxes.Test) -> list[tuple[int, int]]:
    pairs = [np.sort(tree.order[np.stack(p)], axis=0).T for p in tree.pairs(near)]
    return [(int(i), int(j)) for i, j in np.concatenate(pairs)]


def strangers(mesh: Mesh) -> set[tuple[int, int]]:
    i, j = np.triu_indices(mesh.size, 1)
    apart = mesh.disjoint(i, j)
    return set(zip(i[apart].tolist(), j[apart].tolist(), strict=True))


@pytest.mark.parametrize("chunk", [5, 1 << 14])
@pytest.mark.parametrize("mesh", MESHES, ids=str)
def test_every_pair_exactly_once(mesh: Mesh, chunk: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(BoxTree, "chunk", chunk)
    tree = BoxTree.build(mesh, *random_leg(mesh, 3))
    pairs = found(tree, lambda level, a, other, b: np.ones(len(a), dtype=bool))
    assert len(pairs) == len(set(pairs))
    assert set(pairs) == strangers(mesh)


@pytest.mark.parametrize("n", [3, 40, 200])
def test_every_pair_of_edge_and_triangle_exactly_once(n: int) -> None:
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
def test_no_pair_that_can_meet_is_lost(mesh: Mesh, m: int) -> None:
    start, end = random_leg(mesh, m)
    tree = BoxTree.build(mesh, start, end)

    def near(level: Level, a: IntArray, other: Level, b: IntArray) -> BoolArray:
        enter, leave = contact_window(level.gaps(a, other, b))
        return np.asarray(enter <= leave)

    assert set(found(tree, near)) >= overlapping(mesh, start, end)


def overlapping(mesh: Mesh, start: np.ndarray, end: np.ndarray) -> set[tuple[int, int]]:
    """Pairs of edges whose bounding boxes overlap at one of many times, by brute force."""
    pairs = set()
    for t in np.linspace(0, 1, 21):
        p = (1 - t) * start + t * end
        q = p[:, mesh.heads]
        low, high = np.minimum(p, q), np.maximum(p, q)
        meet = (low[:, :, None] <= high[:, None]) & (low[:, None] <= high[:, :, None])
        pairs |= set(zip(*(k.tolist() for k in np.nonzero(meet.all(axis=0))), strict=True))
    return pairs & strangers(mesh)


def test_contact_window() -> None:
    # one row per ± axis, one column per pair of boxes; gaps at the start and at the end
    before = np.array([[1.0, 1.0, -1.0, -1.0, 0.0], [-3.0, -1.0, -1.0, -1.0, -1.0]])
    after = np.array([[-1.0, 2.0, -1.0, 3.0, 0.0], [1.0, -1.0, -1.0, -1.0, -1.0]])
    enter, leave = contact_window(np.stack([before, after]))
    np.testing.assert_allclose(enter, [0.5, np.inf, 0.0, 0.0, 0.0], rtol=1e-12)
    np.testing.assert_allclose(leave, [0.75, 1.0, 1.0, 0.25, 1.0], rtol=1e-12)
