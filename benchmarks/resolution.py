"""How far above the smooth curve's least energy `relax` ends by default: the table in docs/accuracy.md.

    python benchmarks/resolution.py              every prime knot to seven crossings
    python benchmarks/resolution.py 3_1 7_7

The energy of the smooth curve is extrapolated from that of the curve that a run ends at, relaxed on with every edge
halved, and halved again: the ratio of the two differences is 4 where the error is of the midpoint rule's second order.
"""

import sys

from hard_curves import lattice_knot
from mobius_flow.core import RelaxOptions, minimize
from mobius_flow.core.knots import KNOTS
from mobius_flow.lab.extrapolation import extrapolated


def row(name: str) -> str:
    """The result for a coarse lattice polygon."""
    result = minimize(lattice_knot(name))
    found = extrapolated(result.curve, RelaxOptions())
    assert found is not None, f"{name} with shorter edges does not converge"
    above = 100.0 * (result.final_energy / found.energy - 1.0)
    ends = f"{len(result.curve)} | {result.final_energy:.3f} | {found.energy:.4f} ± {found.error:.4f}"
    return f"| {name} | {ends} | {above:.2f} % | {found.ratio:.2f} |"


def main() -> None:
    """Print a table in Markdown."""
    names = sys.argv[1:] or [name for name in KNOTS if "_" in name and 3 <= int(name.split("_")[0]) <= 7]
    print("| knot | vertices | energy | of the smooth curve | above it | ratio |")
    print("| --- | --- | --- | --- | --- | --- |")
    for name in names:
        print(row(name), flush=True)


if __name__ == "__main__":
    main()
