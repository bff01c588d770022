"""``mobius-flow compare``: energy against iterations and seconds for several methods, like Figure 3 of [RS21]."""

import argparse
import csv
import json
import math
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path

from ..core import METHODS, MobiusFlowError
from ..core.curve.io import FORMATS
from ..core.driver.compare import History, compare
from ..core.errors import OptionError, OutputError, counted, wrong_suffix
from ..core.system.files import atomic_write
from . import curves, signals
from . import options as relax_options
from .figures import figure_class
from .places import check_places
from .recovery import kept

_INSTEAD = "or write .csv or .json"
_EPILOG = """\
example:
  mobius-flow compare knot.txt --methods lbfgs,flow-moebius,flow-l2 --time-limit 20 -o figure.png

The column, or key, "energy" of a table is the objective: the energy with the barrier between near strands. Where a
method is stuck another one helps out: "fallback" tells the steps it took, which are dots in a figure.

exit status: 0; 2 on bad input or bad options, or where OUT cannot be written; 130 interrupted, where the methods that
are done are written all the same
"""


def add_to(parser: argparse.ArgumentParser) -> None:
    """Describe the subcommand."""
    parser.description = "Compare methods on a curve: energy against iterations and seconds, like Figure 3 of [RS21]."
    parser.epilog = _EPILOG
    parser.add_argument(
        "input", metavar="IN", help=f"polygons, closed or open: {', '.join(FORMATS)}, or - for standard input"
    )
    curves.add_format(parser)
    parser.add_argument(
        "--methods", metavar="A,B,…", help=f"names, comma separated (default: all: {','.join(METHODS)})"
    )
    parser.add_argument("--time-limit", type=float, default=30.0, metavar="S", help="seconds per method (default: 30)")
    parser.add_argument("-o", "--output", required=True, metavar="OUT", help=f"one of {', '.join(WRITERS)}")
    relax_options.add_to(parser, method=False)
    relax_options.add_task(parser)


def run(options: argparse.Namespace) -> int:
    """Compare, write the figure or table, and print one line per method."""
    suffix = Path(options.output).suffix.lower()
    if suffix not in WRITERS:
        raise OptionError(f"{options.output}: {wrong_suffix(options.output, WRITERS, 'outputs')}")
    if WRITERS[suffix] is _write_figure:
        figure_class(_INSTEAD)
    if not (math.isfinite(options.time_limit) and options.time_limit > 0):
        raise OptionError(f"time-limit is {options.time_limit}; it must be a finite number of seconds above 0")
    names = list(METHODS) if options.methods is None else [name.strip() for name in options.methods.split(",")]
    check_places(relax_options.inputs(options), {"OUT": options.output})
    file = curves.read(options.input, options.format)
    with curves.refusals(file):
        task, wanted = relax_options.task(options, file), relax_options.from_arguments(options)
        planned = compare(task, names, wanted, options.time_limit)
        options.notes.show()
        runs, ended_by = _collected(planned)
    if runs:
        failures = kept(options.output, lambda path: _write(path, WRITERS[suffix], runs))
        if failures:
            raise MobiusFlowError(failures[0])
    if ended_by is not None:
        raise ended_by
    return 0


def _collected(planned: Iterator[History]) -> tuple[list[History], BaseException | None]:
    """The runs that were finished, and what ended them before all were."""
    runs: list[History] = []
    try:
        for result in planned:
            signals.hold()
            runs.append(result)
            print(_line(result), file=sys.stderr, flush=True)
            signals.allow()
    except (KeyboardInterrupt, MemoryError) as error:
        return runs, error
    signals.hold()
    return runs, None


def _write(path: str, writer: Callable[[Path, Sequence[History]], None], runs: Sequence[History]) -> None:
    try:
        with atomic_write(path) as temporary:
            writer(temporary, runs)
    except (OSError, ValueError) as error:
        raise OutputError(path, error) from error


def _line(run: History) -> str:
    return (
        f"{run.method:18} {run.status:16} objective {run.energy[-1]:.9g} after "
        f"{counted(len(run.energy) - 1, 'iteration')}, {run.seconds[-1]:.1f} s, gradient {run.gradient_norm[-1]:.2g}"
    )


def _write_json(path: Path, runs: Sequence[History]) -> None:
    path.write_text(json.dumps([asdict(run) for run in runs], indent=1) + "\n", encoding="utf-8")


def _write_csv(path: Path, runs: Sequence[History]) -> None:
    with path.open("w", encoding="utf-8", newline="") as stream:
        table = csv.writer(stream)
        table.writerow(["method", "status", "iteration", "seconds", "energy", "gradient_norm", "fallback"])
        for run in runs:
            rows = enumerate(zip(run.seconds, run.energy, run.gradient_norm, strict=True))
            table.writerows([run.method, run.status, k, *values, int(k in run.fallback)] for k, values in rows)


def _write_figure(path: Path, runs: Sequence[History]) -> None:
    figure = figure_class(_INSTEAD)(figsize=(13, 6), layout="constrained")
    from matplotlib.ticker import LogFormatter

    left, right = figure.subplots(1, 2, sharey=True)
    for index, run in enumerate(runs):
        style = {"color": f"C{index % 10}", "linestyle": ("-", "--", ":")[index // 10 % 3], "linewidth": 1.4}
        label = run.method if run.status == "converged" else f"{run.method} ({run.status.replace('_', ' ')})"
        helped = {"marker": "o", "markersize": 3, "markevery": list(run.fallback)} if run.fallback else {}
        left.plot(range(len(run.energy)), run.energy, label=label, **style, **helped)
        right.plot(run.seconds, run.energy, **style, **helped)
    left.set(xlabel="iterations", ylabel="objective", xscale="symlog", yscale="log")
    right.set(xlabel="seconds", xscale="log")
    left.yaxis.set(major_formatter=LogFormatter(), minor_formatter=LogFormatter())  # 200, 300, not 2 × 10², 3 × 10²
    for axes in (left, right):
        axes.grid(alpha=0.3)
    figure.legend(*left.get_legend_handles_labels(), loc="outside right center", fontsize="small")
    figure.savefig(path, dpi=130)


WRITERS: Mapping[str, Callable[[Path, Sequence[History]], None]] = {
    ".png": _write_figure,
    ".svg": _write_figure,
    ".csv": _write_csv,
    ".json": _write_json,
}
