"""What a step costs, size by size: the figures in docs/performance.md.

    OPENBLAS_NUM_THREADS=1 python benchmarks/speed.py
    OPENBLAS_NUM_THREADS=1 python benchmarks/speed.py --sizes 200,1000,5000 --json

Steps are taken on a bent trefoil. Printed are milliseconds of processor time: "lists" of near pairs and of pairs of
clusters; "energy"; "derivative", which includes the energy; "metric", building J; "gradient", factorising or
preconditioning the saddle-point system and solving it; "retract", the way back to the constraints; "proof", collision
detection along the step; and "iteration", all that a step takes on average.
"""

import argparse
import json
import sys
from collections.abc import Iterator, Sequence
from dataclasses import asdict, replace

from mobius_flow.cli import options as relax_options
from mobius_flow.cli.options import environment
from mobius_flow.core import MobiusFlowError
from step_costs import ASYMPTOTIC, Machine, Row, exponents, speed

SIZES = (200, 592, 1000, 2000, 5000, 10_000)
_LEAST = 60  # vertices with which the bent knot is still a trefoil
_MILLI, _MEGA = 1e-3, 1e6


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure the machine and every size, and print tables, or JSON at the end."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    default = ",".join(map(str, SIZES))
    parser.add_argument(
        "--sizes", type=_sizes, default=SIZES, metavar="N,N,…", help=f"numbers of vertices (default: {default})"
    )
    parser.add_argument("--json", action="store_true", help="print everything as JSON")
    relax_options.add_to(parser)
    given = parser.parse_args(arguments)
    try:
        wanted = replace(relax_options.from_arguments(given), mesh="fixed")
        machine = Machine.measured()
        rows = speed(given.sizes, wanted)
        if given.json:
            print(json.dumps(_report(machine, list(rows)) | {"options": vars(wanted)} | environment(), indent=1))
        else:
            _print(machine, rows)
    except MobiusFlowError as error:
        parser.error(str(error))
    return 0


def _sizes(text: str) -> list[int]:
    sizes = [int(word) for word in text.split(",")]
    if min(sizes) < _LEAST:
        raise argparse.ArgumentTypeError(f"the curve needs {_LEAST} vertices or more")
    return sizes


def _report(machine: Machine, rows: Sequence[Row]) -> dict[str, object]:
    """All figures as plain values."""
    return {"machine": asdict(machine), "rows": [_plain(machine, row) for row in rows], "exponents": exponents(rows)}


def _plain(machine: Machine, row: Row) -> dict[str, object]:
    return asdict(row) | {"in_products": _ratios(row, machine.product), "in_copies": _ratios(row, machine.copy)}


def _print(machine: Machine, rows: Iterator[Row]) -> None:
    """The rows as they come, then the conclusions from all of them."""
    done: list[Row] = []
    for row in rows:
        if not done:
            print(f"milliseconds of processor time, and the most memory\n{_head(row)}       MB")
        done.append(row)
        print(f"{_line(row, _MILLI)} {row.peak_bytes / _MEGA:8.1f}")
    for unit, seconds in (("products of 1000 × 1000 matrices", machine.product), ("copies of 100 MB", machine.copy)):
        print(f"\nthe same in {unit}, of {seconds / _MILLI:.1f} ms each\n{_head(done[0])}")
        for row in done:
            print(_line(row, seconds))
    conclusions = list(_conclusions(done))
    if conclusions:
        print("\n".join(["", *conclusions]))


def _conclusions(rows: Sequence[Row]) -> Iterator[str]:
    for solver, exponent in exponents(rows).items():
        yield f"{solver} iterations take time like N^{exponent:.2f} from {ASYMPTOTIC} vertices on"
    for row in rows:
        if row.deviation is not None:
            off = row.deviation
            yield (
                f"{row.vertices} vertices, against dense: energy {off.energy:.1e}, derivative {off.derivative:.1e}, "
                f"norm of the gradient {off.norm:.1e}, cosine {off.cosine:.6f}"
            )


def _ratios(row: Row, unit: float) -> dict[str, float]:
    return {name: seconds / unit for name, seconds in row.seconds.items()}


def _head(row: Row) -> str:
    return f"{'vertices':>8} {'solver':12}" + "".join(f" {name:>10}" for name in row.seconds)


def _line(row: Row, unit: float) -> str:
    return f"{row.vertices:8d} {row.solver:12}" + "".join(f" {x:10.3f}" for x in _ratios(row, unit).values())


if __name__ == "__main__":
    sys.exit(main())
