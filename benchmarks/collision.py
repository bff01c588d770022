"""Times of collision detection, in milliseconds of processor time.

    python benchmarks/collision.py curves [VERTICES ...]
    python benchmarks/collision.py obstacle [VERTICES ...] [--mesh MESH.obj]

``curves``: the first contact along a long motion, the proof of a leg two thirds as long, embeddedness, gap, and the
verifier's filter on that leg. ``obstacle``: a curve in a mesh, by default a bumpy sphere of 28,560 triangles; first
contact and proof of the curve alone and with the mesh, clearance, and the filter. Run them with one BLAS thread on a
quiet machine.
"""

import argparse
from collections.abc import Callable, Sequence
from time import process_time

import numpy as np
from mobius_flow.core import Curve, Obstacle, read_obstacle
from mobius_flow.core.base.types import FloatArray
from mobius_flow.core.collision import check_clear, check_embedded, free_motion, is_free, minimal_gap
from mobius_flow.core.proof.filter import doubtful_pairs


def torus_knot(n: int, p: int = 2, q: int = 3) -> FloatArray:
    t = 2 * np.pi * np.arange(n) / n
    radius = 2 + np.cos(q * t)
    return np.stack([radius * np.cos(p * t), radius * np.sin(p * t), np.sin(q * t)], axis=1)


def ribbon(n: int) -> list[FloatArray]:
    """Two strands a third of an edge apart, twisted around each other."""
    middle = torus_knot(n // 2)
    t = 2 * np.pi * np.arange(n // 2) / (n // 2)
    side = np.cross(np.roll(middle, -1, axis=0) - np.roll(middle, 1, axis=0), [0.0, 0.0, 1.0])
    up = np.cross(np.roll(middle, -1, axis=0) - np.roll(middle, 1, axis=0), side)
    side, up = (each / np.linalg.norm(each, axis=1, keepdims=True) for each in (side, up))
    turn = np.cos(5 * t)[:, None] * side + np.sin(5 * t)[:, None] * up
    return [middle, middle + 0.3 * float(np.linalg.norm(middle[1] - middle[0])) * turn]


def sphere(latitudes: int, bumps: float) -> Obstacle:
    """A surface around the origin by its latitudes and as many longitudes, but for the caps at the poles."""
    n = latitudes
    p, q = np.meshgrid(np.pi * (np.arange(n) + 0.5) / n, np.pi * np.arange(n) / (n / 2), indexing="ij")
    radius = 1 + bumps * np.sin(9 * p) * np.sin(7 * q) * np.sin(p)
    points = (radius * np.array([np.sin(p) * np.cos(q), np.sin(p) * np.sin(q), np.cos(p)])).reshape(3, -1).T
    i, j = np.indices((n - 1, n)).reshape(2, -1)
    a, b = n * i + j, n * i + (j + 1) % n
    faces = np.concatenate([[a, b, b + n], [a, b + n, a + n]], axis=1).T
    return Obstacle(points, faces, "bumpy")


def field(points: FloatArray, waves: int) -> FloatArray:
    """A smooth motion of space, of the size of the points."""
    rng, size = np.random.default_rng(8), np.ptp(points, axis=0).max() / 6.0
    angles = points @ (rng.normal(size=(waves, 3)) / size).T + rng.uniform(0, 6, size=waves)
    return np.asarray(size * np.sin(angles) @ rng.normal(size=(waves, 3)))


def best(task: Callable[[], object], repetitions: int) -> float:
    """Milliseconds of processor time."""
    times = []
    for _ in range(repetitions):
        begin = process_time()
        task()
        times.append(process_time() - begin)
    return 1e3 * min(times)


def show(head: str, cells: Sequence[object]) -> None:
    texts = [f"{cell:12.5g}" if isinstance(cell, float) else f"{cell!s:>12}" for cell in cells]
    print(f"{head:20}" + "".join(texts), flush=True)


def curves(sizes: Sequence[int]) -> None:
    show("curve", ("edges", "contact at", "contact", "proof", "embedded", "gap", "verify"))
    for n in sizes:
        repetitions = 5 if n < 5000 else 1
        knots = {"torus knot (2,3)": [torus_knot(n)], "torus knot (7,9)": [torus_knot(n, 7, 9)]}
        for name, components in {**knots, "ribbon": ribbon(n)}.items():
            curve = Curve.from_components(components)
            mesh, start, step = curve.mesh, curve.vertices, field(curve.vertices, 6)
            contact = free_motion(mesh, start, start + step).time
            end = start + 2 / 3 * contact * step
            assert is_free(mesh, start, end)
            tasks = [
                lambda: free_motion(mesh, start, start + step),  # noqa: B023 (called at once)
                lambda: is_free(mesh, start, end),  # noqa: B023
                lambda: check_embedded(curve),  # noqa: B023
                lambda: minimal_gap(curve),  # noqa: B023
                lambda: list(doubtful_pairs(start, end, mesh.heads)),  # noqa: B023
            ]
            show(name, [n, contact, *(best(task, repetitions) for task in tasks[: 5 if n < 50_000 else 4])])


def obstacle(sizes: Sequence[int], given: Obstacle) -> None:
    print(f"{given.name}, {len(given.faces)} triangles")
    titles = ("vertices", "contact at", "alone", "avoiding", "proof alone", "avoiding", "clear", "verify", "obstacle")
    show("share of the room", titles)
    middle = 0.5 * (given.vertices.min(axis=0) + given.vertices.max(axis=0))
    reach = float(np.linalg.norm(given.vertices - middle, axis=1).min())
    for n, share in ((n, share) for n in sizes for share in (0.3, 0.6, 0.9)):  # of the largest curve that fits
        curve = Curve(middle + share * reach * torus_knot(n, 3, 7) / 3.2)
        mesh, start = curve.mesh, curve.vertices
        check_clear(curve, (given,))
        step = field(start, 4)
        time = free_motion(mesh, start, start + step, (given,)).time
        end = start + 2 / 3 * time * step
        tasks = (
            lambda: free_motion(mesh, start, start + step),  # noqa: B023 (called at once)
            lambda: free_motion(mesh, start, start + step, (given,)),  # noqa: B023
            lambda: is_free(mesh, start, end),  # noqa: B023
            lambda: is_free(mesh, start, end, (given,)),  # noqa: B023
            lambda: check_clear(curve, (given,)),  # noqa: B023
            lambda: list(doubtful_pairs(start, end, mesh.heads)),  # noqa: B023
            lambda: list(doubtful_pairs(start, end, mesh.heads, triangles=given.corners)),  # noqa: B023
        )
        show(str(share), [n, time, *(best(task, 5) for task in tasks)])


SIZES = {"curves": [200, 600, 1000, 10_000, 100_000], "obstacle": [2000]}


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table", choices=SIZES)
    parser.add_argument("sizes", nargs="*", type=int, metavar="VERTICES")
    parser.add_argument("--mesh", metavar="MESH.obj", help="an obstacle (default: a bumpy sphere)")
    given = parser.parse_args()
    sizes = given.sizes or SIZES[given.table]
    if given.table == "curves":
        curves(sizes)
    else:
        obstacle(sizes, read_obstacle(given.mesh) if given.mesh else sphere(120, 0.1))


if __name__ == "__main__":
    main()
