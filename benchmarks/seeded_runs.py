"""Fifty seeded runs of all kinds through the public API: a rebuilt program must end each of them as the old one did.

    OPENBLAS_NUM_THREADS=1 python benchmarks/seeded_runs.py --save before.json       record this tree: a minute
    OPENBLAS_NUM_THREADS=1 python benchmarks/seeded_runs.py --against before.json    compare it with the record
    python benchmarks/seeded_runs.py --revision main                  run both by turns, which compares times as well
    python benchmarks/seeded_runs.py goeritz drag --revision main     some of the runs

Printed are runs that differ by the words of their outcome, whatever numbers are among them, by their certificate, or by
more than 1e-9 in their energy; then the exit status is 1. With --revision each run is a process of its own, one at a
time, and the faster of two counts. The inputs are not chaotic: these outcomes stay under other processors' kernels.
"""

import argparse
import json
import math
import os
import re
import subprocess
import sys
import time
from pathlib import Path
from statistics import geometric_mean
from tempfile import TemporaryDirectory

import numpy as np
from mobius_flow.core import Curve, Hand, MobiusFlowError, Obstacle, RelaxOptions, Task, WithOutcome, morph, relax
from mobius_flow.core.knots import cable, knot, overhand, scramble, smooth_knot, torus_knot

sys.path.append(str(Path(__file__).parents[1] / "tools"))
from weight import ROOT, unpacked

EXPLICIT = "lbfgs cg trust-region paper flow-moebius flow-l2 flow-h1 flow-h3-2 flow-h2 penalty-lbfgs penalty-cg"
IMPLICIT = "implicit-moebius implicit-l2 implicit-h1 implicit-h3-2 implicit-h2"  # slower ones
ENERGIES = "vertex edge moebius-k2 moebius-k3 tangent-point"
t = np.linspace(0, 2 * np.pi, 48, endpoint=False)
LOOP = np.stack([1.5 + 1.5 * np.cos(t), 0.25 * np.sin(5 * t), np.sin(t) + 0.2 * np.sin(4 * t)], axis=1)
FRAME = Obstacle(1.2 * np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]), [[0, 1], [1, 2], [2, 3], [3, 0]])
TIPS = 6.0 * np.array([[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]])
CAGE = Obstacle(TIPS, [[k, (k + 1) % 4, top] for k in range(4) for top in (4, 5)])  # an octahedron

BALANCED = {"balance": True, "stability": True, "tolerance": 1e-7}
RUNS = {  # what each run starts from, a pair for a morph, and its options
    **{each: (lambda: knot("5_2", 800), {"method": each, "max_iterations": 4}) for each in EXPLICIT.split()},
    **{each: (lambda: knot("5_2", 240), {"method": each, "max_iterations": 4}) for each in IMPLICIT.split()},
    "nesterov": (lambda: knot("5_2", 800), {"method": "penalty-nesterov", "penalty": 50.0, "max_iterations": 4}),
    **{each: (lambda: knot("4_1", 400), {"energy": each, "max_iterations": 12}) for each in ENERGIES.split()},
    "default": (lambda: knot("5_1"), {}),
    "adaptive": (lambda: knot("8_19"), {"mesh": "adaptive", "max_iterations": 60}),
    "finer": (lambda: knot("4_1", 60), {"mesh": "finer", "tolerance": 1e-6}),
    "sum": (lambda: knot("3_1#3_1", 120), {"terms": (("bending", 0.1),)}),
    "cable": (lambda: cable(smooth_knot("3_1", 100), 2, 1, 200), {"quadrature_points": 2, "max_iterations": 15}),
    "balance": (lambda: scramble(smooth_knot("3_1", 60), 1, moves=200), BALANCED),
    "plane": (lambda: Curve(LOOP[:, [0, 2]]), {"vertices": 400}),
    "rings": (lambda: knot("L6a4", 150), {"edge_lengths": "keep", "max_iterations": 20}),
    "apart": (lambda: Curve.from_components([LOOP, 9 + LOOP[:, [2, 0, 1]]]), {}),
    "arc": (lambda: overhand(60), {}),
    "ends": (lambda: Task(curve=overhand(60), pins=(0, 59), pin_tangents=True), {}),
    "pins": (lambda: Task(curve=knot("4_1", 80), pins=(0, 20, 50)), {"max_iterations": 30}),
    "frame": (lambda: Task(curve=Curve(LOOP), obstacles=(FRAME,)), {"vertices": 400}),
    "cage": (lambda: Task(curve=knot("4_1"), obstacles=(CAGE,)), {"solver": "hierarchical", "max_iterations": 12}),
    "packing": (lambda: Task(curve=knot("3_1"), obstacles=(CAGE,)), {"grow": 2.0, "max_iterations": 30}),
    "shrinking": (lambda: Task(curve=knot("5_2", 120), pins=(0,)), {"grow": 0.7, "max_iterations": 30}),
    "hops": (lambda: torus_knot(3, 4, 60), {"mesh": "fixed", "vertices": 60, "hops": 2, "seed": 3, "tolerance": 1e-7}),
    "D4": (lambda: torus_knot(3, 4, 96), {"symmetry": "D4", "vertices": 192, "escape_saddles": True}),
    "S4": (lambda: smooth_knot("4_1", 80), {"symmetry": "auto"}),
    "goeritz": (lambda: knot("goeritz"), {}),
    "always": (lambda: knot("d28"), {"untangle": "always"}),
    "hierarchical": (lambda: knot("5_2", 500), {"solver": "hierarchical", "max_iterations": 12}),
    "two": (lambda: knot("L5a1", 400), {"solver": "hierarchical", "accuracy": 1e-3, "max_iterations": 10}),
    "large": (lambda: torus_knot(2, 5, 3000), {"vertices": 3000, "max_iterations": 4}),
    "drag": (lambda: knot("4_1", 120), {"max_iterations": 20}),
    "morph": (lambda: (knot("4_1"), scramble(smooth_knot("m4_1", 60), 1, moves=200)), {}),
    "unknots": (lambda: (knot("goeritz"), knot("culprit")), {}),
    "different": (lambda: (knot("8_8", 240), knot("10_129", 240)), {}),
}


def ended(name: str) -> dict[str, object]:
    """How a run ends."""
    began, (make, options) = time.process_time(), RUNS[name]
    try:
        start, hand = make(), Hand() if name == "drag" else None
        run = None if isinstance(start, tuple) else WithOutcome(relax(start, RelaxOptions(**options), hand))
        for last in run or ():
            if hand and last.index == 4:
                hand.grab(0, 0.25)
                hand.move([2.0, 1.0, 3.0])
            elif hand and last.index == 12:
                hand.release()
        if run is None:
            last = (run := morph(*start, RelaxOptions(**options))).last
        found = str(run.outcome.message), last.index, last.energy, last.certified, len(last.curve)
    except MobiusFlowError as error:
        found = str(error), 0, 0.0, False, 0
    keys = ("outcome", "iterations", "energy", "certified", "vertices", "seconds")
    return dict(zip(keys, (*found, time.process_time() - began), strict=True))


def by_turns(names: list[str], revision: str) -> tuple[dict, dict]:
    """The runs of a revision and of this tree."""
    rows = ({}, {})
    with unpacked(revision) as old, TemporaryDirectory() as room:
        Path(room, "mobius_flow").symlink_to(ROOT)
        for name, side in ((name, side) for name in names for side in (0, 1, 1, 0)):
            env = os.environ | {"PYTHONPATH": str((old.parent, room)[side]), "OPENBLAS_NUM_THREADS": "1"}
            subprocess.run([sys.executable, __file__, name, "--save", f"{room}/run.json"], env=env, check=True)
            row = json.loads(Path(room, "run.json").read_text(encoding="utf-8"))[name]
            rows[side][name] = min(row, rows[side].get(name, row), key=lambda each: each["seconds"])
    return rows


def compared(before: dict, after: dict) -> int:
    """Print what differs and how times compare; return 1 if anything differs."""
    differ, pairs = 0, [(before[name], row) for name, row in after.items()]
    for name, (old, new) in zip(after, pairs, strict=True):
        near = math.isclose(old["energy"], new["energy"], rel_tol=1e-9, abs_tol=1e-9)  # a straight arc has 0
        said = {(re.sub(r"[-−]?\d[\d.,]*(e[+-]?\d+)?", "#", row["outcome"]), row["certified"]) for row in (old, new)}
        if len(said) > 1 or not near:
            differ = 1
            print(name, *old.values(), sep=" | ")
            print(" " * len(name), *new.values(), sep=" | ")
    moved = [sum(old[key] != new[key] for old, new in pairs) for key in ("iterations", "vertices")]
    print(f"{len(pairs)} runs, {moved[0]} with other iterations, {moved[1]} with other vertices")
    first, second = (sum(pair[side]["seconds"] for pair in pairs) for side in (0, 1))
    mean = geometric_mean(new["seconds"] / old["seconds"] for old, new in pairs)
    print(f"{first:.1f} → {second:.1f} s of processor time, × {second / first:.3f}; geometric mean × {mean:.3f}")
    return differ


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", default=list(RUNS), metavar="NAME", help=f"runs: {', '.join(RUNS)}")
    mode = parser.add_mutually_exclusive_group(required=True)
    for flag, value in (("--save", "FILE.json"), ("--against", "FILE.json"), ("--revision", "REV")):
        mode.add_argument(flag, metavar=value)
    given = parser.parse_args()
    if given.revision:
        return compared(*by_turns(given.names, given.revision))
    rows = {name: ended(name) for name in given.names}
    if given.against:
        return compared(json.loads(Path(given.against).read_text(encoding="utf-8")), rows)
    Path(given.save).write_text(json.dumps(rows, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
