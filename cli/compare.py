"""``mobius-flow compare`` and ``methods``: what several methods make of a curve, like Figures 1 and 3 of [RS21]."""

import argparse
import csv
import json
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, replace
from functools import partial
from pathlib import Path

from ..core import METHODS, MobiusFlowError
from ..core.driver.compare import History, compare
from ..core.errors import OptionError, counted, wrong_suffix
from . import curves, signals
from . import options as relax_options
from .figures import figure_class, write_figure, write_strip
from .places import check_places, kept, writing
from .streams import emit

Writer = Callable[[Path, Sequence[History]], None]
_EPILOG = """\
examples:
  mobius-flow compare knot.txt --methods lbfgs,flow-moebius,flow-l2 --time-limit 20 -o figure.png
  mobius-flow compare knot.txt --methods flow-moebius,flow-l2 --strip 0,5,20,80 -o strip.png

A figure shows the energy, its distance to the least one, and the gradient norm, each over iterations and over seconds
of processor time, which a busy machine does not change. The column, or key, "energy" of a table is the objective: the
energy with the barrier between near strands, without the penalty of the methods that have one. The least one is taken
over the methods that keep lengths. Where a method is stuck a fallback method takes over: "fallback" marks its steps,
which are dots in a figure. When its time is up, a method is stopped even in the middle of a step.

exit status: 0; 2 on bad input or bad options, or where OUT cannot be written; 130 interrupted, where the methods that
are done are written all the same
"""


def add_compare(parser: argparse.ArgumentParser) -> None:
    parser.description = "Compare methods on a curve: energy and gradient against iterations and seconds."
    parser.epilog = _EPILOG
    curves.add_input(parser, "polygons, closed or open")
    parser.add_argument(
        "--methods", metavar="A,B,…", help=f"names, comma separated (default: all: {','.join(METHODS)})"
    )
    limit = "limit per method, in seconds of processor time, all threads together (default: 30)"
    parser.add_argument("--time-limit", type=float, default=30.0, metavar="SECONDS", help=limit)
    strip = "instead of graphs, draw the curves after these numbers of iterations, one row per method"
    parser.add_argument("--strip", metavar="K,K,…", help=strip)
    parser.add_argument("-o", "--output", required=True, metavar="OUT", help=f"figure or table: {', '.join(WRITERS)}")
    relax_options.add_to(parser, without=("method", "time_limit"))
    relax_options.add_task(parser)
    parser.set_defaults(run=_compare)


def _compare(options: argparse.Namespace) -> int:
    """Write the figure or table, and print one line per method."""
    suffix = Path(options.output).suffix.lower()
    if suffix not in WRITERS:
        raise OptionError(f"{options.output}: {wrong_suffix(options.output, WRITERS, 'outputs')}")
    writer, stages = WRITERS[suffix], list[int]()
    if options.strip is not None:
        refusal = "strip has {}; give numbers of iterations, such as 0,10,50"
        stages = sorted(set(relax_options.listed(options.strip, 0, refusal)))
    if stages and writer is not write_figure:
        raise OptionError(f"{options.output}: a strip is a picture; let OUT end in .png or .svg, or leave --strip out")
    if writer is write_figure:
        figure_class("or write .csv or .json")
        writer = partial(write_strip, stages) if stages else writer
    names = list(METHODS) if options.methods is None else [name.strip() for name in options.methods.split(",")]
    check_places(relax_options.inputs(options), {"OUT": options.output})
    file = curves.read(options.input, options.format)
    with curves.refusals(file):
        task, wanted = relax_options.task(options, file), relax_options.from_arguments(options)
        if stages:  # nothing after the last one is drawn
            wanted = replace(wanted, max_iterations=min(wanted.max_iterations, stages[-1]))
        planned = compare(task, names, wanted, options.time_limit, stages)
        options.notes.show()
        runs, ended_by = list[History](), None
        try:
            for run in signals.interruptible(planned):
                runs.append(run)
                print(_line(run), file=sys.stderr, flush=True)
        except (KeyboardInterrupt, MemoryError) as error:
            ended_by = error

    def write(path: str) -> None:
        with writing(path) as temporary:
            writer(temporary, runs)

    if runs and (failures := kept(options.output, write)):
        raise MobiusFlowError(failures[0])
    if ended_by is not None:
        raise ended_by
    return 0


def add_methods(parser: argparse.ArgumentParser) -> None:
    parser.description = "List the descent methods: name, a tab, what it is; those for comparison come last."
    parser.epilog = "exit status: 0"
    parser.set_defaults(run=_methods)


def _methods(_options: argparse.Namespace) -> int:
    emit("\n".join(f"{name}\t{method.sentence}" for name, method in METHODS.items()))
    return 0


def _line(run: History) -> str:
    return (
        f"{run.method:18} {run.status:16} objective {run.energy[-1]:.9g} after "
        f"{counted(run.iterations, 'iteration')}, {run.seconds[-1]:.1f} s, gradient {run.gradient_norm[-1]:.2g}"
    )


def _write_json(path: Path, runs: Sequence[History]) -> None:
    names = [each.name for each in fields(History) if each.name != "stages"]
    plain = [{name: getattr(run, name) for name in names} for run in runs]
    path.write_text(json.dumps(plain, indent=1) + "\n", encoding="utf-8")


def _write_csv(path: Path, runs: Sequence[History]) -> None:
    with path.open("w", encoding="utf-8", newline="") as stream:
        table = csv.writer(stream)
        table.writerow(["method", "status", "iteration", "seconds", "energy", "gradient_norm", "fallback"])
        for run in runs:
            rows = enumerate(zip(run.seconds, run.energy, run.gradient_norm, strict=True))
            table.writerows([run.method, run.status, k, *values, int(k in run.fallback)] for k, values in rows)


WRITERS: Mapping[str, Writer] = {".png": write_figure, ".svg": write_figure, ".csv": _write_csv, ".json": _write_json}
