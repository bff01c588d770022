"""How far above the smooth curve's least energy `relax` ends by default: the table in docs/energies.md.

    python benchmarks/resolution.py              every prime knot to seven crossings
    python benchmarks/resolution.py 3_1 7_7

The curve that a run ends at is relaxed on with every edge halved, and halved again.  The midpoint rule's error is of
second order, so that a third of the last difference is left, and the ratio of the two is 4 where that is so.
"""

import sys

import numpy as np
from mobius_flow.core import Curve, RelaxOptions, minimize
from mobius_flow.core.bench import PRIMES
from mobius_flow.core.curve.refine import subdivide
from mobius_flow.core.hierarchy import moebius_energy

CROSSINGS = 7


def halved(curve: Curve) -> Curve:
    """Where the curve ends with two edges in place of each."""
    finer = subdivide(curve, np.full(len(curve), 2))
    return minimize(finer, RelaxOptions(mesh="fixed", vertices=len(finer), edge_lengths="keep")).curve


def row(name: str) -> str:
    """What becomes of a coarse lattice polygon."""
    curves = [minimize(PRIMES[name]()).curve]
    for _ in range(2):
        curves.append(halved(curves[-1]))
    coarse, middle, fine = (moebius_energy(curve)[0] for curve in curves)
    smooth = fine + (fine - middle) / 3.0
    above = 100.0 * (coarse / smooth - 1.0)
    ratio = (coarse - middle) / (middle - fine)
    return f"| {name} | {len(curves[0])} | {coarse:.3f} | {smooth:.3f} | {above:.2f} % | {ratio:.2f} |"


def main() -> None:
    """Print a table in Markdown."""
    knots = [name for name in PRIMES if "_" in name and int(name.split("_")[0]) <= CROSSINGS]
    print("| knot | vertices | energy | of the smooth curve | above it | ratio |")
    print("| --- | --- | --- | --- | --- | --- |")
    for name in sys.argv[1:] or knots:
        print(row(name), flush=True)


if __name__ == "__main__":
    main()
