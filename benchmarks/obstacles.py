"""Obstacles: times of collision detection, and how its answers compare with exact arithmetic.

    python benchmarks/obstacles.py [MESH.obj]          a curve in a mesh, by default a bumpy sphere of 28,800 triangles
    python benchmarks/obstacles.py --motions 105000    random and adversarial motions of an edge near a triangle

The first prints milliseconds of processor time for the curve alone and with the obstacle; run it with one BLAS thread
on a quiet machine. In the second nothing may be wrong, and hardly anything timid; it takes ten minutes.
"""

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from time import process_time

import numpy as np
from mobius_flow.core import Curve, Obstacle, read_obstacle
from mobius_flow.core.base.types import FloatArray
from mobius_flow.core.collision import check_clear, free_motion, is_free
from mobius_flow.core.proof.filter import doubtful_pairs

REPETITIONS = 5
SHARES = (0.3, 0.6, 0.9)  # of the largest curve that fits


def bumpy_sphere(rings: int = 120) -> Obstacle:
    """A closed surface around the origin."""
    p, q = np.meshgrid(np.linspace(0, np.pi, rings + 1), np.pi * np.arange(rings) / (rings / 2), indexing="ij")
    radius = 1 + 0.1 * np.sin(9 * p) * np.sin(7 * q) * np.sin(p)
    points = (radius * np.array([np.sin(p) * np.cos(q), np.sin(p) * np.sin(q), np.cos(p)])).reshape(3, -1).T
    i, j = np.indices((rings, rings)).reshape(2, -1)
    a, b = rings * i + j, rings * i + (j + 1) % rings
    faces = np.concatenate([[a, b, b + rings], [a, b + rings, a + rings]], axis=1)
    return Obstacle(points, faces.T, "bumpy sphere")


def knot_inside(obstacle: Obstacle, share: float, n: int) -> Curve:
    """A knotted curve around the obstacle's centre that reaches a share of the way to its nearest vertex."""
    center = 0.5 * (obstacle.vertices.min(axis=0) + obstacle.vertices.max(axis=0))
    reach = float(np.linalg.norm(obstacle.vertices - center, axis=1).min())
    t = 2 * np.pi * np.arange(n) / n
    radius = 2 + np.cos(7 * t)
    points = np.stack([radius * np.cos(3 * t), radius * np.sin(3 * t), np.sin(7 * t)], axis=1)
    return Curve(center + share * reach * points / 3.2)


def field(points: FloatArray) -> FloatArray:
    """A smooth motion of space, of the size of the points."""
    rng, size = np.random.default_rng(8), np.ptp(points, axis=0).max()
    waves = rng.normal(size=(4, 3)) / size
    return np.asarray(size * np.sin(points @ waves.T + rng.uniform(0, 6, size=4)) @ rng.normal(size=(4, 3)) / 4)


def best(task: Callable[[], object]) -> float:
    """Milliseconds of processor time."""
    times = []
    for _ in range(REPETITIONS):
        begin = process_time()
        task()
        times.append(process_time() - begin)
    return 1e3 * min(times)


def timings(obstacle: Obstacle, n: int) -> None:
    print(f"{obstacle.name}, {len(obstacle.faces)} triangles; {n} vertices")
    last = ("clear", "verify", "obstacle")
    titles = ("share", "contact at", "alone", "avoiding", "proof alone", "avoiding", *last)
    print("".join(f"{title:>13}" for title in titles))
    for share in SHARES:
        curve = knot_inside(obstacle, share, n)
        mesh, start = curve.mesh, curve.vertices
        check_clear(curve, (obstacle,))
        step = field(start)
        time = free_motion(mesh, start, start + step, (obstacle,)).time
        end = start + 2 / 3 * time * step
        tasks: tuple[Callable[[], object], ...] = (
            lambda: free_motion(mesh, start, start + step),  # noqa: B023 (called at once)
            lambda: free_motion(mesh, start, start + step, (obstacle,)),  # noqa: B023
            lambda: is_free(mesh, start, end),  # noqa: B023
            lambda: is_free(mesh, start, end, (obstacle,)),  # noqa: B023
            lambda: check_clear(curve, (obstacle,)),  # noqa: B023
            lambda: list(doubtful_pairs(start, end, mesh.heads)),  # noqa: B023
            lambda: list(doubtful_pairs(start, end, mesh.heads, triangles=obstacle.corners)),  # noqa: B023
        )
        print(f"{share:13.1f}{time:13.4f}" + "".join(f"{best(task):13.2f}" for task in tasks), flush=True)


def soak(motions: int) -> None:
    sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
    from exact_decisions import Tally
    from obstacle_motions import KINDS, free, meets, placed

    for kind in KINDS:
        rng, tally = np.random.default_rng(20261), Tally(meets)
        for _ in range(motions // len(KINDS)):
            start, end = placed(rng, kind(rng))
            tally.add(start, end, free(start, end))
        print(f"{kind.__name__:12} {tally}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("mesh", nargs="?", help="an obstacle")
    parser.add_argument("--vertices", type=int, default=2000)
    parser.add_argument("--motions", type=int, default=0)
    options = parser.parse_args()
    if options.motions:
        soak(options.motions)
    else:
        timings(bumpy_sphere() if options.mesh is None else read_obstacle(options.mesh), options.vertices)


if __name__ == "__main__":
    main()
