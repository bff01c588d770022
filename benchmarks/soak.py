"""Thousands of short flows on random curves: type changes, contacts, NaNs and uncaught exceptions must all be 0.

OPENBLAS_NUM_THREADS=1 python benchmarks/soak.py --flows 2000 --seed 1
OPENBLAS_NUM_THREADS=1 python benchmarks/soak.py --flows 500 --world    arcs, pins and obstacles; all of it verified
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
from mobius_flow.core import METHODS, Curve, Iterate, MobiusFlowError, Obstacle, RelaxOptions, Task, Trajectory, relax
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
    kind = rng.integers(6)
    if kind == 0:
        curve = Curve(rng.normal(size=(int(rng.integers(5, 25)), 3)))
    elif kind == 1:
        curve = Curve.from_components(
            [rng.normal(size=(int(rng.integers(3, 9)), 3)) for _ in range(rng.integers(1, 5))]
        )
    elif kind == 2:
        curve = knot(str(rng.choice([name for name in KNOTS if name[0] in "34567L"])))
    elif kind == 3:
        curve = scramble(knot(str(rng.choice(["0_1", "3_1", "4_1"])), 60), seed=int(rng.integers(1 << 30)), moves=600)
    elif kind == 4:
        strands = int(rng.integers(2, 5))
        word = rng.choice([-1, 1], size=int(rng.integers(2, 9))) * rng.integers(
            1, strands, size=1 if strands == 2 else None
        )
        curve = braid_closure([int(x) for x in np.atleast_1d(word)], strands=strands)
    else:
        curve = hard_unknot(int(rng.integers(4, 14)), seed=int(rng.integers(1 << 30)))
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


def random_obstacles(rng: np.random.Generator, curve: Curve) -> list[Obstacle]:
    """Triangles and segments among the strands, as far as they are clear of them, and perhaps a box around."""
    middle, half = 0.5 * (curve.vertices.max(axis=0) + curve.vertices.min(axis=0)), 0.5 * np.ptp(curve.vertices)
    found = []
    for _ in range(rng.integers(0, 6)):
        corners = int(rng.integers(2, 4))
        simplex = rng.uniform(-1.0, 1.0, 3) + 10.0 ** rng.uniform(-2.0, 1.0) * rng.normal(size=(corners, 3))
        found.append(Obstacle(middle + half * simplex, [list(range(corners))], "simplex"))
    if rng.random() < 0.5:
        signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
        faces = [triangle for a, b, c, d in quads for triangle in ((a, b, c), (a, c, d))]
        found.append(Obstacle(middle + half * (1.0 + 10.0 ** rng.uniform(-6.0, 0.0)) * signs, faces, "box"))
    return [each for each in found if clears(curve, [each], 1e-9 * half)]


def in_the_world(rng: np.random.Generator, curve: Curve) -> Task:
    """Open some components, pin some vertices, and add obstacles."""
    closed = rng.random(len(curve.components)) < 0.5
    curve = Curve.from_components(curve.components, closed.tolist())
    pins = rng.choice(len(curve), size=int(rng.integers(0, 5)), replace=False)
    tangents = bool(rng.random() < 0.3)
    avoid = random_obstacles(rng, curve)
    return Task(curve=curve, obstacles=avoid, pins=pins, pin_tangents=tangents and len(pins) > 0)


def is_accepted(iterates: Sequence[Iterate], task: Task) -> bool:
    """Whether the independent check accepts the motion, and every pin has kept its place."""
    trajectory = Trajectory(obstacles=task.obstacles)
    for iterate in iterates:
        trajectory.add(iterate)
    with tempfile.TemporaryDirectory() as room:
        trajectory.save(Path(room) / "path.npz")
        accepted = verify(Path(room) / "path.npz").accepted
    first, last = (set(map(tuple, i.curve.vertices[list(i.pins)].tolist())) for i in (iterates[0], iterates[-1]))
    return accepted and first <= last


def flow(rng: np.random.Generator, world: bool = False) -> str:
    """Run one flow and say how it went: "ok", "refused", "type", "contact", "nan" or "exception"."""
    try:
        curve = random_curve(rng)
        task = Task(curve=curve)
        options = random_options(rng, len(curve))
        if world:
            task = in_the_world(rng, curve)
        iterates = list(relax(task, options))
    except MobiusFlowError:
        return "refused"
    numbers = [value for i in iterates for value in (i.energy, i.gradient_norm, *i.curve.vertices[0])]
    if not np.isfinite(numbers).all():
        return "nan"
    if world and not is_accepted(iterates, task):
        return "contact"
    if not task.curve.mesh.all_closed:
        return "ok"
    return "ok" if quick_invariants(curve) == quick_invariants(iterates[-1].curve) else "type"


def main() -> int:
    """Run the soak and print the counts."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--flows", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--world", action="store_true", help="with open components, pins and obstacles")
    arguments = parser.parse_args()
    counts: Counter[str] = Counter()
    started = time.perf_counter()
    for k in range(arguments.flows):
        seed = [arguments.seed, k]
        try:
            outcome = flow(np.random.default_rng(seed), arguments.world)
        except Exception:
            traceback.print_exc()
            outcome = "exception"
        counts[outcome] += 1
        if outcome not in ("ok", "refused"):
            print(f"flow {seed}: {outcome}", flush=True)
        if (k + 1) % 100 == 0:
            print(f"{k + 1} flows: {dict(counts)}", flush=True)
    seconds = time.perf_counter() - started
    print(
        f"{arguments.flows} flows in {seconds:.0f} s: {counts['type']} type changes, "
        f"{counts['contact']} contacts, {counts['nan']} NaNs, "
        f"{counts['exception']} exceptions; {counts['ok']} relaxed, {counts['refused']} refused with a sentence"
    )
    return int(sum(counts[bad] for bad in ("type", "contact", "nan", "exception")) > 0)


if __name__ == "__main__":
    sys.exit(main())
