"""``mobius-flow bench speed``: what a step costs, size by size."""

import argparse
import json
from collections.abc import Iterator, Sequence
from dataclasses import asdict

from ..core.errors import OptionError
from ..core.speed import ASYMPTOTIC, SIZES, Machine, Row, exponents, fixed_mesh, speed
from . import options as relax_options
from .provenance import environment
from .streams import emit

_MILLI, _MEGA = 1e-3, 1e6


def add_to(parser: argparse.ArgumentParser) -> None:
    """Describe the options that ``bench`` has for this."""
    group = parser.add_argument_group("speed")
    default = ",".join(map(str, SIZES))
    group.add_argument("--sizes", metavar="N,N,…", help=f"numbers of vertices, comma separated (default: {default})")
    group.add_argument("--json", action="store_true", help="print everything as JSON")


def run(options: argparse.Namespace) -> int:
    """Measure the machine and every size, and print tables, or JSON at the end."""
    sizes = SIZES if options.sizes is None else _numbers(options.sizes)
    wanted = fixed_mesh(sizes, relax_options.from_arguments(options))
    machine = Machine.measured()
    rows = speed(sizes, wanted)
    if options.json:
        emit(json.dumps(_report(machine, list(rows)) | {"options": vars(wanted)} | environment(), indent=1))
    else:
        _print(machine, rows)
    return 0


def _numbers(text: str) -> list[int]:
    words = [word.strip() for word in text.split(",")]
    wrong = next((word for word in words if not (word.isascii() and word.isdecimal() and len(word) < 10)), None)
    if wrong is not None:
        raise OptionError(f"sizes has {wrong!r:.40}; give numbers of vertices, such as 200,1000,5000")
    return [int(word) for word in words]


def _report(machine: Machine, rows: Sequence[Row]) -> dict[str, object]:
    """All figures as plain values."""
    return {"machine": asdict(machine), "rows": [_plain(machine, row) for row in rows], "exponents": exponents(rows)}


def _plain(machine: Machine, row: Row) -> dict[str, object]:
    return asdict(row) | {"in_products": _ratios(row, machine.product), "in_copies": _ratios(row, machine.copy)}


def _print(machine: Machine, rows: Iterator[Row]) -> None:
    """The rows as they come, then what follows from all of them."""
    done: list[Row] = []
    for row in rows:
        if not done:
            emit(f"milliseconds of processor time, and the most memory\n{_head(row)}       MB")
        done.append(row)
        emit(f"{_line(row, _MILLI)} {row.peak_bytes / _MEGA:8.1f}")
    for unit, seconds in (("products of 1000 × 1000 matrices", machine.product), ("copies of 100 MB", machine.copy)):
        emit(f"\nthe same in {unit}, of {seconds / _MILLI:.1f} ms each\n{_head(done[0])}")
        for row in done:
            emit(_line(row, seconds))
    conclusions = list(_conclusions(done))
    if conclusions:
        emit("\n".join(["", *conclusions]))


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
