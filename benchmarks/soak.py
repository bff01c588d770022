"""Thousands of short flows on random curves: type changes, contacts, NaNs and uncaught exceptions must all be 0.

    OPENBLAS_NUM_THREADS=1 python benchmarks/soak.py --count 2000 --seed 1
    OPENBLAS_NUM_THREADS=1 python benchmarks/soak.py --count 500 --kind world    arcs, pins and obstacles; all verified

The path is verified like its file, and the type identified before and after.
"""

import argparse
import sys
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from hard_curves import hard_unknot
from mobius_flow.core import (
    METHODS,
    Curve,
    Iterate,
    MobiusFlowError,
    Obstacle,
    RelaxOptions,
    Task,
    Trajectory,
    relax,
)
from mobius_flow.core.collision.embedded import clears
from mobius_flow.core.driver.options import EDGE_LENGTHS, MESHES
from mobius_flow.core.energies import ENERGIES
from mobius_flow.core.knots import KNOTS, braid_closure, knot, scramble
from mobius_flow.core.knots.diagrams import quick_invariants
from mobius_flow.core.proof import verify

# slow kinds, and those that change the mesh, come up less often
COMMON = ("lbfgs", "cg", "flow-moebius", "flow-h1", "flow-l2", "flow-h2", "penalty-lbfgs", "penalty-nesterov")


def random_curve(rng: np.random.Generator) -> Curve:
    """A polygon of a random kind, in random units at a random place."""
    kind, seed = rng.integers(6), int(rng.integers(1 << 30))
    if kind == 0:
        curve = Curve(rng.normal(size=(int(rng.integers(5, 25)), 3)))
    elif kind == 1:
        sizes = rng.integers(3, 9, size=rng.integers(1, 5))
        curve = Curve.from_components([rng.normal(size=(int(size), 3)) for size in sizes])
    elif kind == 2:
        curve = knot(str(rng.choice([name for name in KNOTS if name[0] in "34567L"])))
    elif kind == 3:
        curve = scramble(knot(str(rng.choice(["0_1", "3_1", "4_1"])), 60), seed=seed, moves=600)
    elif kind == 4:
        strands, signs = int(rng.integers(2, 5)), rng.choice([-1, 1], size=int(rng.integers(2, 9)))
        word = signs * rng.integers(1, strands, size=1 if strands == 2 else len(signs))
        curve = braid_closure([int(x) for x in word], strands=strands)
    else:
        curve = hard_unknot(int(rng.integers(4, 14)), seed=seed)
    scale, shift = 10.0 ** rng.uniform(-6, 6), rng.normal(size=3) * 10.0 ** rng.uniform(-2, 2)
    return curve.with_vertices(scale * (curve.vertices + shift))


def random_options(rng: np.random.Generator, given: int) -> RelaxOptions:
    """Options of every kind for a curve of so many vertices; mostly coarse meshes, which are quick and harder."""
    method = str(rng.choice(COMMON if rng.random() < 0.8 else list(METHODS)))
    energies = [name for name in ENERGIES if not METHODS[method].rule.second_order or name == "moebius"]
    mesh = str(rng.choice(MESHES, p=[0.35, 0.35, 0.1, 0.2]))
    return RelaxOptions(
        method=method,
        energy=str(rng.choice(energies)) if rng.random() < 0.2 else "moebius",
        mesh=mesh,
        vertices=int(given * rng.uniform(1.0, 2.0)) if rng.random() < 0.8 else None,
        edge_lengths="auto" if mesh == "adaptive" else str(rng.choice(EDGE_LENGTHS)),
        max_iterations=int(rng.integers(1, 9)),
    )


def in_the_world(rng: np.random.Generator, curve: Curve) -> Task:
    """Open some components, pin some vertices, and add triangles and segments among the strands, perhaps in a box."""
    curve = Curve.from_components(curve.components, (rng.random(len(curve.components)) < 0.5).tolist())
    middle, half = 0.5 * (curve.vertices.max(axis=0) + curve.vertices.min(axis=0)), 0.5 * np.ptp(curve.vertices)
    found = []
    for corners in rng.integers(2, 4, size=rng.integers(0, 6)):
        simplex = rng.uniform(-1.0, 1.0, 3) + 10.0 ** rng.uniform(-2.0, 1.0) * rng.normal(size=(int(corners), 3))
        found.append(Obstacle(middle + half * simplex, [list(range(corners))], "simplex"))
    if rng.random() < 0.5:
        signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
        faces = [triangle for a, b, c, d in quads for triangle in ((a, b, c), (a, c, d))]
        found.append(Obstacle(middle + half * (1.0 + 10.0 ** rng.uniform(-6.0, 0.0)) * signs, faces, "box"))
    clear = [each for each in found if clears(curve, [each], 1e-9 * half)]
    pins = rng.choice(len(curve), size=int(rng.integers(0, 5)), replace=False)
    return Task(curve=curve, obstacles=clear, pins=pins, pin_tangents=bool(rng.random() < 0.3) and len(pins) > 0)


def problem(iterates: Sequence[Iterate], task: Task) -> str:
    """What is wrong with a run, after an independent check of its motion: "type", "contact", "nan", or "ok"."""
    first, last = iterates[0], iterates[-1]
    if not np.isfinite([value for i in iterates for value in (i.energy, i.gradient_norm, *i.curve.vertices[0])]).all():
        return "nan"
    trajectory = Trajectory(obstacles=task.obstacles)
    for iterate in iterates:
        trajectory.add(iterate)
    with tempfile.TemporaryDirectory() as room:
        trajectory.save(Path(room) / "path.npz")
        accepted = verify(Path(room) / "path.npz").accepted
    stay, there = (set(map(tuple, i.curve.vertices[list(i.pins)].tolist())) for i in (first, last))
    if not (accepted and all(i.certified for i in iterates) and stay <= there):
        return "contact"
    closed = task.curve.mesh.all_closed
    return "type" if closed and quick_invariants(task.curve) != quick_invariants(last.curve) else "ok"


def flow(rng: np.random.Generator, kind: str = "flows") -> str:
    """Run one flow, and say how it went, also "refused" if a sentence says why."""
    try:
        curve = random_curve(rng)
        options = random_options(rng, len(curve))
        task = in_the_world(rng, curve) if kind == "world" else Task(curve=curve)
        return problem(list(relax(task, options)), task)
    except MobiusFlowError:
        return "refused"


def main() -> int:
    """Run the soak and print the counts."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kind", choices=("flows", "world"), default="flows")
    given = parser.parse_args()
    counts, started = Counter[str](), time.perf_counter()
    for k in range(given.count):
        try:
            outcome = flow(np.random.default_rng([given.seed, k]), given.kind)
        except Exception:
            traceback.print_exc()
            outcome = "exception"
        counts[outcome] += 1
        if outcome not in ("ok", "refused"):
            print(f"{[given.seed, k]}: {outcome}", flush=True)
    bad = {name: counts[name] for name in ("type", "contact", "nan", "exception")}
    seconds = time.perf_counter() - started
    print(f"{given.count} {given.kind} in {seconds:.0f} s: {bad}, the others {counts - Counter(bad)}")
    return int(any(bad.values()))


if __name__ == "__main__":
    sys.exit(main())
