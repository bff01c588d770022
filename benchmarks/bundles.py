"""Random bundles of strands between two plates, separated, as docs/separate.md tells.

    OPENBLAS_NUM_THREADS=1 python benchmarks/bundles.py [COUNT [FIRST]]

Strands of radius 1 lead from a hexagonal lattice, filled to 20 to 60 %, to a random permutation of its places, every
second bundle with bends. A row tells strands, points of each, packing, height of the bundle, crossings of centre lines,
processor seconds, the least distance of strands over two radii, measured here by brute force, the largest displacement,
the least bending radius, the lengths' ratio, and the verdict on the trajectory. Exit status 1 if anything is not as it
should be.
"""

import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from mobius_flow.core import Curve, Trajectory, separate
from mobius_flow.core.proof import verify


def bundle(seed: int) -> tuple[Curve, tuple[int, int, float, float]]:
    """A bundle of 5 to 40 strands of 14 to 40 points; and strands, points, packing, height."""
    rng = np.random.default_rng(seed)
    strands, points = int(rng.integers(5, 41)), int(rng.integers(14, 41))
    packing, height = float(rng.uniform(0.2, 0.6)), float(rng.uniform(20.0, 40.0))
    gap = np.sqrt(2.0 * np.pi / (np.sqrt(3.0) * packing))  # of the lattice
    grid = np.arange(-8, 9)
    below = gap * np.array([(x + 0.5 * y, np.sqrt(0.75) * y) for x in grid for y in grid])
    below = below[np.argsort(np.linalg.norm(below - [0.1, 0.07], axis=1))[:strands]]
    t = np.linspace(0.0, 1.0, points)[:, None]
    made = []
    for here, there in zip(below, below[rng.permutation(strands)], strict=True):
        flat = (1.0 - t) * here + t * there
        if seed % 2:
            flat = flat + gap * (
                np.sin(np.pi * t) ** 2 * rng.normal(size=2) + np.sin(2 * np.pi * t) * rng.normal(size=2) / 2
            )
        made.append(np.hstack([flat, height * t]))
    return Curve.from_components(made, [False] * strands), (strands, points, packing, height)


def least_distance(parts: list[np.ndarray]) -> float:
    """The least distance between two polylines, by all pairs of edges: at ends, or where both are inside."""
    least = np.inf
    for k, p in enumerate(parts):
        others = parts[k + 1 :]
        if not others:
            break
        x, e = p[:-1, None], (p[1:] - p[:-1])[:, None]
        y = np.concatenate([q[:-1] for q in others])[None]
        f = np.concatenate([q[1:] - q[:-1] for q in others])[None]
        ee, ff, ef = (e * e).sum(-1), (f * f).sum(-1), (e * f).sum(-1)
        candidates = []
        for end in (0.0, 1.0):
            s = np.clip(((y + end * f - x) * e).sum(-1) / ee, 0.0, 1.0)
            candidates.append((s, np.full_like(s, end)))
            t = np.clip(((x + end * e - y) * f).sum(-1) / ff, 0.0, 1.0)
            candidates.append((np.full_like(t, end), t))
        sine = np.maximum(ee * ff - ef * ef, 1e-300)
        ew, fw = (e * (x - y)).sum(-1), (f * (x - y)).sum(-1)
        s, t = (ef * fw - ff * ew) / sine, (ee * fw - ef * ew) / sine
        inside = (s > 0.0) & (s < 1.0) & (t > 0.0) & (t < 1.0)
        candidates.append((np.where(inside, s, 0.0), np.where(inside, t, 0.0)))
        for s, t in candidates:
            apart = x + s[..., None] * e - y - t[..., None] * f
            least = min(least, float(np.sqrt((apart * apart).sum(-1)).min()))
    return least


def bend(parts: list[np.ndarray]) -> float:
    """The least radius of circles through three points in a row."""
    radii = []
    for p in parts:
        a, b = p[1:-1] - p[:-2], p[2:] - p[1:-1]
        sides = [np.linalg.norm(each, axis=1) for each in (a, b, a + b)]
        radii.append(sides[0] * sides[1] * sides[2] / np.maximum(2.0 * np.linalg.norm(np.cross(a, b), axis=1), 1e-300))
    return float(np.concatenate(radii).min())


def main() -> int:
    failed, seconds = 0, []
    print("seed strands points packing height crossings    s  apart  moved  bend length verdict")
    count, first = (int(each) for each in (*sys.argv[1:3], *("100", "0")[len(sys.argv) - 1 :]))
    for seed in range(first, first + count):
        curve, (strands, points, packing, height) = bundle(seed)
        trajectory, began = Trajectory(), time.process_time()
        result = separate(curve, 1.0, callback=trajectory.add)
        seconds.append(time.process_time() - began)
        with TemporaryDirectory() as room:
            trajectory.save(Path(room, "path.npz"))
            verdict = verify(Path(room, "path.npz"))
        ends, parts = [each.vertices[each.mesh.ends] for each in (curve, result.curve)], list(result.curve.components)
        apart = least_distance(parts) / 2.0
        still = np.array_equal(*ends)  # long edges are cut, so that numbers differ
        good = result.outcome.converged and still and apart >= 1.0 and verdict.accepted
        failed += not good
        numbers = f"{seed:4} {strands:7} {points:6} {packing:7.2f} {height:6.1f} {len(result.outcome.crossings):9}"
        measured = f"{seconds[-1]:5.1f} {apart:6.4f} {result.outcome.moved:6.2f} {bend(parts):5.1f}"
        ratio = f"{result.curve.length / curve.length:6.3f}"
        print(numbers, measured, ratio, "accepted" if good else f"NO: {result.message}", flush=True)
    print(f"{failed} failed; {np.median(seconds):.1f} s (median), {max(seconds):.1f} s (most)")
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
