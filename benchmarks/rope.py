"""What a rope costs: runs that keep nine tenths of the thickness against runs without.

    OPENBLAS_NUM_THREADS=1 python benchmarks/rope.py [NAME or FILE …] [--vertices N] [--solver hierarchical]

Without names: famous unknots, knots and links of the table.  "thickness" is the least of all iterates over the start's,
"radius" what is left of the rope's where it gave way, "above" how far the energy at rest is above that without, in per
cent, and "time" the processor time of an iteration over that without.  Both runs take turns, iteration by iteration.
"""

import argparse
import time
from collections.abc import Sequence
from math import inf
from pathlib import Path
from statistics import median

from mobius_flow.core import Iterate, RelaxOptions, read_curve, relax
from mobius_flow.core.collision import thickness
from mobius_flow.core.energies.hierarchy import moebius_energy
from mobius_flow.core.knots import HARD_UNKNOTS, KNOTS, knot

NAMES = [*(name for name in HARD_UNKNOTS if name != "haken"), *list(KNOTS)[1:41], "L2a1", "L4a1", "L5a1", "L6a4"]


def main(arguments: Sequence[str] | None = None) -> None:
    """Print a row for each curve, and medians."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", default=NAMES)
    parser.add_argument("--vertices", type=int)
    parser.add_argument("--iterations", type=int, default=1500)
    parser.add_argument("--solver", default="auto")
    given = parser.parse_args(arguments)
    titles = f"{'steps':>11} {'ratio':>6} {'thickness':>9} {'radius':>6} {'above':>7} {'time':>5}"
    print(f"{'curve':22} {'vertices':>8} {titles}")
    rows = []
    for name in given.names:
        curve = read_curve(name) if Path(name).exists() else knot(name)
        options = {"max_iterations": given.iterations, "vertices": given.vertices, "solver": given.solver}
        runs = {radius: relax(curve, RelaxOptions(radius=radius, **options)) for radius in ("none", "keep")}
        seconds, iterates = dict.fromkeys(runs, 0.0), {radius: list[Iterate]() for radius in runs}
        going, least = list(runs), inf
        while going:
            for radius in list(going):
                began = time.process_time()
                iterate = next(runs[radius], None)
                if iterate is not None and iterate.radius is not None:  # as `minimize` measures it
                    least = thickness(iterate.curve, least)
                if iterates[radius]:  # the start costs what it costs
                    seconds[radius] += time.process_time() - began
                if iterate is None:
                    going.remove(radius)
                else:
                    iterates[radius].append(iterate)
        (free, rope), (free_time, rope_time) = iterates.values(), seconds.values()
        start, end = rope[0].radius, rope[-1].radius
        steps = [len(each) - 1 for each in (free, rope)]
        energies = [moebius_energy(each[-1].curve)[0] for each in (free, rope)]
        row = (
            steps[1] / steps[0],
            least / thickness(rope[0].curve),
            end[0] / start[0] if start and end else 0.0,
            100.0 * (energies[1] / energies[0] - 1.0),
            rope_time / steps[1] / (free_time / steps[0]),
        )
        ratio, thick, left, above, slower = row
        print(
            f"{name[-22:]:22} {len(rope[-1].curve):8} {steps[0]:4} → {steps[1]:4} {ratio:6.2f} {thick:9.3f} "
            f"{left:6.2f} {above:7.3f} {slower:5.2f}",
            flush=True,
        )
        rows.append(row)
    ratio, thick, left, above, slower = map(median, zip(*rows, strict=True))
    kept = [each[1] for each in rows if each[2] == 1.0]
    print(f"{'median':22} {'':8} {'':11} {ratio:6.2f} {thick:9.3f} {left:6.2f} {above:7.3f} {slower:5.2f}")
    print(f"{len(kept)} of {len(rows)} did not give way, and kept a thickness of {min(kept, default=1.0):.3f}")


if __name__ == "__main__":
    main()
