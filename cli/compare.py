"""``mobius-flow compare``: energy against iterations and seconds for several methods, like Figure 3 of [RS21]."""

import argparse
import csv
import json
import math
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

from ..core import METHODS, read_curve
from ..core.compare import Run, compare
from ..core.errors import MobiusFlowError, OptionError
from ..core.files import atomic_write
from ..core.setup import method_named
from . import options as relax_options

if TYPE_CHECKING:
    Subparsers = argparse._SubParsersAction[argparse.ArgumentParser]


def add_to(subparsers: "Subparsers") -> None:
    """Add the subcommand."""
    parser = subparsers.add_parser("compare", help="compare descent methods on a curve", description=__doc__)
    parser.add_argument("input", metavar="IN", help="closed polygons: .txt/.xyz, .obj, .vect or .json")
    parser.add_argument(
        "--methods", metavar="A,B,…", help=f"names, comma separated (default: all: {','.join(METHODS)})"
    )
    parser.add_argument("--time-limit", type=float, default=30.0, metavar="S", help="seconds per method (30)")
    parser.add_argument("-o", "--output", required=True, metavar="OUT", help=f"one of {', '.join(WRITERS)}")
    relax_options.add_to(parser, method=False)
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Compare, write the figure or table, and print one line per method."""
    path = Path(options.output)
    if path.suffix.lower() not in WRITERS:
        raise OptionError(f"{path}: unknown suffix {path.suffix!r}; outputs end in {', '.join(WRITERS)}")
    if not (math.isfinite(options.time_limit) and options.time_limit > 0):
        raise OptionError(f"time-limit is {options.time_limit}; it must be a finite number of seconds above 0")
    names = list(METHODS) if options.methods is None else [name.strip() for name in options.methods.split(",")]
    for name in names:
        method_named(name)
    wanted = relax_options.from_arguments(options)
    runs = []
    for result in compare(read_curve(options.input), names, wanted, options.time_limit):
        runs.append(result)
        print(_line(result), file=sys.stderr, flush=True)
    try:
        with atomic_write(path) as temporary:
            WRITERS[path.suffix.lower()](temporary, runs)
    except OSError as error:
        raise MobiusFlowError(f"{path}: cannot be written: {error.strerror or error}") from error
    return 0


def _line(run: Run) -> str:
    return (
        f"{run.method:18} {run.status:16} energy {run.energy[-1]:.9g} after {len(run.energy) - 1} iterations, "
        f"{run.seconds[-1]:.1f} s, gradient {run.gradient_norm[-1]:.2g}"
    )


def _write_json(path: Path, runs: Sequence[Run]) -> None:
    path.write_text(json.dumps([asdict(run) for run in runs], indent=1) + "\n", encoding="utf-8")


def _write_csv(path: Path, runs: Sequence[Run]) -> None:
    with path.open("w", encoding="utf-8", newline="") as stream:
        table = csv.writer(stream)
        table.writerow(["method", "status", "iteration", "seconds", "energy", "gradient_norm"])
        for run in runs:
            rows = enumerate(zip(run.seconds, run.energy, run.gradient_norm, strict=True))
            table.writerows([run.method, run.status, k, *values] for k, values in rows)


def _write_figure(path: Path, runs: Sequence[Run]) -> None:
    try:
        from matplotlib.figure import Figure
    except ImportError as error:
        raise MobiusFlowError(
            "figures need matplotlib, which is not installed; try pip install matplotlib, or write .csv or .json"
        ) from error
    figure = Figure(figsize=(13, 6), layout="constrained")
    left, right = figure.subplots(1, 2, sharey=True)
    for index, run in enumerate(runs):
        style = {"color": f"C{index % 10}", "linestyle": ("-", "--", ":")[index // 10 % 3], "linewidth": 1.4}
        label = run.method if run.status == "converged" else f"{run.method} ({run.status.replace('_', ' ')})"
        left.plot(range(len(run.energy)), run.energy, label=label, **style)
        right.plot(run.seconds, run.energy, **style)
    left.set(xlabel="iterations", ylabel="objective", xscale="symlog", yscale="log")
    right.set(xlabel="seconds", xscale="log")
    for axes in (left, right):
        axes.grid(alpha=0.3)
    figure.legend(*left.get_legend_handles_labels(), loc="outside right center", fontsize="small")
    figure.savefig(path, dpi=130)


WRITERS: Mapping[str, Callable[[Path, Sequence[Run]], None]] = {
    ".png": _write_figure,
    ".svg": _write_figure,
    ".csv": _write_csv,
    ".json": _write_json,
}
