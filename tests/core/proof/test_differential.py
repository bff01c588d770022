"""The whole searches of program and ``verify``, with folds, boxes and planes, agree about polygons side by side.

MOBIUS_FLOW_DIFFERENTIAL=100000 makes it a million motions, which takes an hour.
"""

import os
from collections import Counter
from collections.abc import Callable, Iterator
from functools import partial

import motions
import numpy as np
from degenerate_motions import KINDS, Motion, Rng
from exact_decisions import meet
from mobius_flow.core import Mesh
from mobius_flow.core.base.types import FloatArray
from mobius_flow.core.collision import is_free
from mobius_flow.core.proof.filter import doubtful_pairs

COUNT = int(os.environ.get("MOBIUS_FLOW_DIFFERENTIAL", "90"))
BATCH = 200
# the four vertices of a motion as two arcs, as one, or as a quadrilateral
POLYGONS = (((2, 2), (False, False)), ((4,), (False,)), ((4,), (True,)))


def random_motion(rng: Rng, m: int) -> tuple[str, Motion]:
    """Mostly steps of any length from anywhere; one in fifty is of a nasty kind, in the plane or in space."""
    if rng.random() < 0.98:
        start = rng.normal(size=(4, m))
        return "step", (start, start + 10.0 ** rng.uniform(-3.0, 0.0) * rng.normal(size=(4, m)))
    while True:
        tame: list[Callable[[Rng], Motion]] = [partial(kind, m=m) for kind in motions.KINDS]
        k = int(rng.integers(len(tame) + len(KINDS)))
        start, end = [*tame, *KINDS][k](rng)
        if start.shape[1] == m:
            return [*motions.KINDS, *KINDS][k].__name__, (start, end)


def apart(rng: Rng, moving: list[Motion]) -> FloatArray:
    """The motions in cells of a lattice, each far from the others; shape (2, motions, 4, m).

    Cells are as large as a power of two, so that small whole numbers and dyadic fractions stay what they are.
    """
    frames = np.stack(moving, axis=1)
    m = frames.shape[-1]
    cell = 2.0 ** np.ceil(np.log2(np.abs(frames).max()) + 1.5)
    side = int(np.ceil(len(moving) ** (1 / m)))
    places = rng.permutation(side**m)[: len(moving)]
    return np.asarray(frames + cell * (np.stack(np.unravel_index(places, (side,) * m), axis=1) - side // 2)[:, None])


def meeting_ones(frames: FloatArray, mesh: Mesh) -> set[int]:
    """Which of the motions side by side have a contact, by the decision of `verify`."""
    heads = np.arange(mesh.size)
    heads[mesh.tails] = mesh.heads
    start, end = frames.reshape(2, mesh.size, -1)
    found: set[int] = set()
    for corners in np.concatenate([np.empty((4, 0), int), *doubtful_pairs(start, end, heads)], axis=1).T:
        k = int(corners[0]) // 4
        if k not in found and meet(start[corners], end[corners]):
            found.add(k)
    return found


def refused(frames: FloatArray, mesh: Callable[[int], Mesh]) -> Iterator[int]:
    """Which motions `is_free` refuses: asked about many together, and about halves if it refuses these."""
    count = frames.shape[1]
    if is_free(mesh(count), *frames.reshape(2, 4 * count, -1)):
        return
    if count == 1:
        yield 0
        return
    for first, part in ((0, frames[:, : count // 2]), (count // 2, frames[:, count // 2 :])):
        yield from (first + k for k in refused(part, mesh))


def compared(seed: int) -> Counter[str]:
    """How many of a batch of random motions are free, how many meet, and, by their kind, what is wrongly called so."""
    rng, counts = np.random.default_rng([417, seed]), Counter[str]()
    m, (sizes, closed) = 3 - int(rng.random() < 0.1), POLYGONS[rng.integers(len(POLYGONS))]
    names, moving = zip(*(random_motion(rng, m) for _ in range(BATCH)), strict=True)

    def mesh(count: int) -> Mesh:
        return Mesh(sizes * count, closed * count)

    frames = apart(rng, list(moving))
    meet_there = meeting_ones(frames, mesh(BATCH))
    free_there = [k for k in range(BATCH) if k not in meet_there]
    hits = [free_there[k] for k in refused(frames[:, free_there], mesh)] if free_there else []
    for k in meet_there:
        if is_free(mesh(1), *frames[:, k]):
            counts[f"false free: {names[k]}"] += 1
    counts.update({"meet": len(meet_there), "free": len(free_there)})
    counts.update(f"false hit: {names[k]}" for k in hits)
    return counts


def test_polygons_are_free_if_no_pair_meets() -> None:
    total = sum((compared(seed) for seed in range(max(1, COUNT // 30))), Counter[str]())
    print(dict(total))
    assert min(total["free"], total["meet"]) > COUNT // 60
    assert not {name for name in total if name.startswith("false")}
