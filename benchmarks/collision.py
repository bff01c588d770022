"""Times of collision detection: python benchmarks/collision.py [vertices ...]

One line per curve: the first contact along a long motion, the proof of a leg two thirds as long, embeddedness, gap, and
the verifier's filter on that leg, in milliseconds of processor time. Run it with one BLAS thread on a quiet machine.
"""

from collections.abc import Callable, Iterator
from time import process_time

import numpy as np
from mobius_flow.core import Curve
from mobius_flow.core.base.types import FloatArray
from mobius_flow.core.collision import check_embedded, free_motion, is_free, minimal_gap
from mobius_flow.core.proof.filter import doubtful_pairs
from words import words


def torus_knot(n: int, p: int = 2, q: int = 3) -> FloatArray:
    t = 2 * np.pi * np.arange(n) / n
    radius = 2 + np.cos(q * t)
    return np.stack([radius * np.cos(p * t), radius * np.sin(p * t), np.sin(q * t)], axis=1)


def tangle(n: int) -> FloatArray:
    """A smooth closed curve that winds everywhere."""
    rng, k = np.random.default_rng(3), np.arange(1, 25)
    t = 2 * np.pi * np.outer(np.arange(n), k) / n
    a, b = rng.normal(size=(2, len(k), 3))
    return np.cos(t) @ a + np.sin(t) @ b


def ribbon(n: int) -> list[FloatArray]:
    """Two strands a third of an edge apart, twisted around each other."""
    middle = torus_knot(n // 2)
    t = 2 * np.pi * np.arange(n // 2) / (n // 2)
    tangents = np.roll(middle, -1, axis=0) - np.roll(middle, 1, axis=0)
    side = np.cross(tangents, [0.0, 0.0, 1.0])
    up = np.cross(tangents, side)
    turn = sum(
        c[:, None] * v / np.linalg.norm(v, axis=1, keepdims=True)
        for c, v in ((np.cos(5 * t), side), (np.sin(5 * t), up))
    )
    gap = 0.3 * float(np.linalg.norm(middle[1] - middle[0]))
    return [middle, middle + gap * turn]


CURVES: dict[str, Callable[[int], list[FloatArray]]] = {
    "torus knot (2,3)": lambda n: [torus_knot(n)],
    "torus knot (7,9)": lambda n: [torus_knot(n, 7, 9)],
    "tangle": lambda n: [tangle(n)],
    "ribbon": ribbon,
}


def field(points: FloatArray) -> FloatArray:
    """A smooth motion of space, of the size of the curve."""
    rng = np.random.default_rng(8)
    waves = rng.normal(size=(6, 3))
    return np.sin(points @ waves.T + rng.uniform(0, 6, size=6)) @ rng.normal(size=(6, 3))


def best(task: Callable[[], object], repetitions: int) -> float:
    """Milliseconds of processor time."""
    times = []
    for _ in range(repetitions):
        begin = process_time()
        task()
        times.append(process_time() - begin)
    return 1e3 * min(times)


def main(sizes: list[int]) -> None:
    titles = ("edges", "contact at", "contact", "proof", "embedded", "gap", "verify")
    print(f"{'curve':18}" + "".join(f"{title:>11}" for title in titles))
    for n in sizes:
        for name, make in CURVES.items():
            times = measure(Curve.from_components(make(n)), 5 if n < 5000 else 1)
            print(f"{name:18}{n:11d}{next(times):11.5f}" + "".join(f"{time:11.2f}" for time in times), flush=True)


def measure(curve: Curve, repetitions: int) -> Iterator[float]:
    mesh, start, step = curve.mesh, curve.vertices, field(curve.vertices)
    contact = free_motion(mesh, start, start + step).time
    end = start + 2 / 3 * contact * step
    assert is_free(mesh, start, end)
    yield contact
    yield best(lambda: free_motion(mesh, start, start + step), repetitions)
    yield best(lambda: is_free(mesh, start, end), repetitions)
    yield best(lambda: check_embedded(curve), repetitions)
    yield best(lambda: minimal_gap(curve), repetitions)
    if len(curve) < 50_000:
        yield best(lambda: list(doubtful_pairs(start, end, mesh.heads)), repetitions)


if __name__ == "__main__":
    main(words(__doc__, "vertices", [200, 600, 1000, 10_000, 100_000], int))
