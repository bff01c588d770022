"""Relax hard curves, and compare their knot types before and after.

    OPENBLAS_NUM_THREADS=1 python benchmarks/knots.py knots --only unknot-lattice-40,8_19
    OPENBLAS_NUM_THREADS=1 python benchmarks/knots.py primes
    OPENBLAS_NUM_THREADS=1 python benchmarks/knots.py woven --only 4_1,7_7

``knots`` are hard curves of all kinds, unknots of up to 141 crossings among them; ``primes`` are the knots to ten
crossings and the links of the table, as coarse lattice polygons; ``woven`` are the 249 prime knots as mobius-flow knot
draws them. The column "energy" is the Möbius energy of the result, as mobius-flow energy prints it, "above" how far in
per cent that is above the smooth curve's in core/knots/least_energies.csv, and "dgemms" is processor time in products
of two 1000 × 1000 matrices. Exit status 1: a type changed, an unknot is no circle, or a proof is missing.
"""

import argparse
import csv
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path

import numpy as np
from hard_curves import hard_unknot, lattice_knot, lattice_unknot, rope, spiral, uneven
from mobius_flow.cli import options as relax_options
from mobius_flow.core import Curve, MobiusFlowError, RelaxOptions, Status, minimize
from mobius_flow.core.knots import HARD_UNKNOTS, KNOTS, knot, scramble, torus_knot
from mobius_flow.core.knots.diagrams import quick_invariants
from speed import machine

Curves = Mapping[str, Callable[[], Curve]]
HARD: Curves = {
    **{f"unknot-{c}": partial(hard_unknot, c, seed=c) for c in (20, 60, 100, 141)},
    **{f"unknot-lattice-{c}": partial(lattice_unknot, c, seed=c) for c in (20, 40, 60, 80, 100, 120, 141)},
    # haken's 141 crossings take more vertices to untangle
    **{f"unknot-{name}": partial(knot, name) for name in HARD_UNKNOTS if name != "haken"},
    "unknot-scrambled": lambda: scramble(knot("0_1"), seed=11),
    "unknot-spiral": lambda: spiral(6.0),
    "unknot-rope": lambda: rope(6.0, 0.02),
    "unknot-edges-1000": lambda: uneven(hard_unknot(20, seed=3), 1000.0, seed=5),
    **{name: partial(lattice_knot, name) for name in ("3_1", "6_2", "7_7", "8_19", "9_35", "10_132")},
    "4_1-scrambled": lambda: scramble(knot("4_1"), seed=7),
    "torus-3-5": lambda: torus_knot(3, 5),
    **{name: partial(lattice_knot, name) for name in ("L2a1", "L5a1", "L6a4")},
}
PRIMES: Curves = {name: partial(lattice_knot, name) for name in KNOTS if name != "0_1"}
WOVEN: Curves = {name: partial(knot, name) for name in KNOTS if "_" in name and name != "0_1"}
SETS = {"knots": HARD, "primes": PRIMES, "woven": WOVEN}
TABLE = Path(__file__).resolve().parents[1] / "core" / "knots" / "least_energies.csv"
LEAST = {row["type"]: float(row["energy"]) for row in csv.DictReader(TABLE.read_text(encoding="utf-8").splitlines())}


def main(arguments: Sequence[str] | None = None) -> int:
    """Print a row for each curve."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("set", choices=SETS, help="hard curves of all kinds, or the table")
    parser.add_argument("--only", metavar="A,B,…", help=f"names, comma separated, such as {', '.join(HARD)}")
    relax_options.add_to(parser)
    given = parser.parse_args(arguments)
    curves = SETS[given.set]
    names = [name.strip() for name in given.only.split(",")] if given.only else list(curves)
    if unknown := [name for name in names if name not in curves]:
        parser.error(f"curve {unknown[0]!r} is unknown; choose from {', '.join(curves)}")
    try:
        wanted = relax_options.from_arguments(given)
        product, width = machine()["product"], max(map(len, ["curve", *names]))
        print(
            f"{'curve':{width}} {'vertices':>17} {'type':>8} {'energy':>12} {'above':>7} {'steps':>6} {'seconds':>8} "
            f"{'dgemms':>7}  certified  status"
        )
        rows = [row(name, curves[name](), wanted, width, product) for name in names]
    except MobiusFlowError as error:
        parser.error(str(error))
    good, *figures = zip(*rows, strict=True)
    for title, values in zip(("dgemms", "above, in %"), figures, strict=True):
        if known := [value for value in values if np.isfinite(value)]:
            median, most, worst = np.percentile(known, [50, 95, 100])
            print(f"{title}: median {median:.3g}, 95 % up to {most:.3g}, worst {worst:.3g}, of {len(known)}")
    return 0 if all(good) else 1


def row(name: str, curve: Curve, options: RelaxOptions, width: int, product: float) -> tuple[bool, float, float]:
    """Relax a curve and print the result: whether it is right, what it cost, and how far it is above the least energy.

    ``product`` is the time of a product of matrices, in seconds.
    """
    began = time.process_time()
    result = minimize(curve, options)
    seconds = time.process_time() - began
    if result.status is Status.INTERRUPTED:  # an interrupt ends the benchmark, not only the current curve
        raise KeyboardInterrupt
    before, after = quick_invariants(curve), quick_invariants(result.curve)
    is_knot = len(curve.mesh.component_sizes) == 1
    kind = "CHANGED" if before != after else "unknot" if after.is_trivial and is_knot else "kept"
    sizes = " → ".join(str(size) for size in (len(curve), *(phase.vertices for phase in result.phases[-2:])))
    above = 100.0 * (result.final_energy / LEAST.get(name.removesuffix("-scrambled"), np.nan) - 1.0)
    print(
        f"{name:{width}} {sizes:>17} {kind:>8} {result.final_energy:12.6f} {f'{above:.2f} %':>7} "
        f"{result.iterations:6d} {seconds:8.1f} {seconds / product:7.0f}  "
        f"{'yes' if result.certified else 'NO':9}  {result.status.value}",
        flush=True,
    )
    round_circle = not name.startswith("unknot") or result.final_energy < 4.02
    return before == after and result.certified and round_circle, seconds / product, above


if __name__ == "__main__":
    sys.exit(main())
