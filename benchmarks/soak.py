"""Thousands of short flows on random curves: type changes, NaNs and uncaught exceptions must all be 0.

OPENBLAS_NUM_THREADS=1 python benchmarks/soak.py --flows 2000 --seed 1
"""

import argparse
import sys
import time
import traceback
from collections import Counter

import numpy as np
from mobius_flow.core import METHODS, Curve, MobiusFlowError, RelaxOptions, relax
from mobius_flow.core.driver.options import EDGE_LENGTHS, MESHES
from mobius_flow.core.energies import ENERGIES
from mobius_flow.core.knots import KNOTS, braid_closure, hard_unknot, knot, scramble
from mobius_flow.core.knots.alexander import signature

# slow ones and those that change the mesh come up less often
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


def flow(rng: np.random.Generator) -> str:
    """Run one flow and say how it went: "ok", "refused", "type", "nan" or "exception"."""
    try:
        curve = random_curve(rng)
        iterates = list(relax(curve, random_options(rng, len(curve))))
    except MobiusFlowError:
        return "refused"
    numbers = [value for i in iterates for value in (i.energy, i.gradient_norm, *i.curve.vertices[0])]
    if not np.isfinite(numbers).all():
        return "nan"
    return "ok" if signature(curve) == signature(iterates[-1].curve) else "type"


def main() -> int:
    """Run the soak and print the counts."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--flows", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    counts: Counter[str] = Counter()
    started = time.perf_counter()
    for k in range(arguments.flows):
        seed = [arguments.seed, k]
        try:
            outcome = flow(np.random.default_rng(seed))
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
        f"{arguments.flows} flows in {seconds:.0f} s: {counts['type']} type changes, {counts['nan']} NaNs, "
        f"{counts['exception']} exceptions; {counts['ok']} relaxed, {counts['refused']} refused with a sentence"
    )
    return int(counts["type"] + counts["nan"] + counts["exception"] > 0)


if __name__ == "__main__":
    sys.exit(main())
