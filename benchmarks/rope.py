"""What a rope costs: runs that keep nine tenths of the thickness against runs without.

    OPENBLAS_NUM_THREADS=1 python benchmarks/rope.py [NAME or FILE …] [--vertices N] [--solver hierarchical]

Without names: famous unknots, knots and links of the table.  "thickness" is the least of all iterates over the start's,
"radius" what is left of the rope's where it gave way, "above" how far the energy at rest is above that without, in per
cent, and "time" that of an iteration, in processor time.
"""

import argparse
import time
from collections.abc import Sequence
from pathlib import Path
from statistics import median

from mobius_flow.core import Curve, Iterate, RelaxOptions, Result, minimize, read_curve
from mobius_flow.core.collision import thickness
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
        (free, _, free_time), (rope, start, rope_time) = (
            run(curve, RelaxOptions(radius=radius, **options)) for radius in ("none", "keep")
        )
        assert rope.last.radius is not None
        assert rope.least_thickness is not None
        left = rope.last.radius[0] / start.radius[0] if start.radius else 0.0
        row = (
            rope.iterations / free.iterations,
            rope.least_thickness / thickness(start.curve),
            left,
            100.0 * (rope.final_energy / free.final_energy - 1.0),
            rope_time / free_time,
        )
        ratio, thick, left, above, slower = row
        print(
            f"{name[-22:]:22} {len(rope.curve):8} {free.iterations:4} → {rope.iterations:4} {ratio:6.2f} {thick:9.3f} "
            f"{left:6.2f} {above:7.3f} {slower:5.2f}",
            flush=True,
        )
        rows.append(row)
    ratio, thick, left, above, slower = map(median, zip(*rows, strict=True))
    kept = [each[1] for each in rows if each[2] == 1.0]
    print(f"{'median':22} {'':8} {'':11} {ratio:6.2f} {thick:9.3f} {left:6.2f} {above:7.3f} {slower:5.2f}")
    print(f"{len(kept)} of {len(rows)} did not give way, and kept a thickness of {min(kept, default=1.0):.3f}")


def run(curve: Curve, options: RelaxOptions) -> tuple[Result, Iterate, float]:
    """The result, the first iterate, and processor seconds for each iteration."""
    iterates: list[Iterate] = []
    began = time.process_time()
    result = minimize(curve, options, callback=iterates.append)
    return result, iterates[0], (time.process_time() - began) / max(result.iterations, 1)


if __name__ == "__main__":
    main()
