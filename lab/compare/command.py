"""``mobius-flow compare`` and ``methods``: what several methods make of a curve, like Figures 1 and 3 of [RS21]."""

import argparse
import csv
import json
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, replace
from functools import partial
from pathlib import Path

from ...cli import curves, signals
from ...cli import options as relax_options
from ...cli.places import check_places, kept
from ...cli.progress import live
from ...cli.terminal import emit, power, say_written, sentence, table, width_of
from ...core import METHODS, MobiusFlowError
from ...core.base import OptionError, atomic_write, counted, wrong_suffix
from .comparison import History, variants
from .comparison import compare as compared
from .figures import figure_class, write_figure, write_strip

Writer = Callable[[Path, Sequence[History]], None]
_COLUMNS = ("method", "status", "iterations", "rises", "fallback", "s", "objective", "gradient")


def usual() -> list[str]:
    """The methods that are there to be used, rather than to be compared with."""
    return [name for name, method in METHODS.items() if not method.comparison]


def compare(options: argparse.Namespace) -> int:
    """Announce the methods, print the table of what they did, and write the figure or table that is asked for."""
    writer, stages = _writer(options)
    names = [name.strip() for name in options.methods.split(",")] if options.methods else usual()
    check_places(relax_options.inputs(options), {"OUT": options.output})
    file = curves.read(options.input, options.format)
    with curves.refusals(file):
        task, wanted = relax_options.task(options, file), relax_options.from_arguments(options)
        if stages:  # nothing after the last one is drawn
            wanted = replace(wanted, max_iterations=min(wanted.max_iterations, stages[-1]))
        planned = compared(task, names, wanted, options.time_limit, stages)
        options.notes.show()
        names = [f"{each.method}:{each.metric}" if each.metric else each.method for each in variants(names, wanted)]
        more = "" if options.methods else f"; --methods '*' takes all {len(METHODS)}"
        most = options.time_limit * len(names)
        told = f"comparing {', '.join(names)}: at most {options.time_limit:g} s each, {most:g} s in all{more}"
        print(sentence(told, sys.stderr), file=sys.stderr, flush=True)
        runs, ended_by = list[History](), None
        try:
            with live() as show:
                show(f"{names[0]}: 1 of {counted(len(names), 'method')}")
                for run in signals.interruptible(planned):
                    runs.append(run)
                    k = min(len(runs), len(names) - 1)
                    show(f"{names[k]}: {k + 1} of {counted(len(names), 'method')}")
        except (KeyboardInterrupt, MemoryError) as error:
            ended_by = error
    if runs:
        cells = [
            (
                run.label,
                run.status.replace("_", " "),
                *(str(run.iterations), str(run.rises or ""), str(len(run.fallback) or "")),
                *(f"{run.seconds[-1]:.1f}", f"{run.energy[-1]:.6g}", power(run.gradient_norm[-1])),
            )
            for run in runs
        ]
        emit(table(_COLUMNS, cells, sys.stdout))

    def write(path: str) -> None:
        with atomic_write(path) as temporary:
            writer(temporary, runs)

    if runs and options.output is not None:
        if failures := kept(options.output, write):
            raise MobiusFlowError(failures[0])
        say_written(options.output)
    if ended_by is not None:
        raise ended_by
    return 0


def _writer(options: argparse.Namespace) -> tuple[Writer, list[int]]:
    """What writes OUT, and the numbers of iterations whose curves it draws; an OptionError if they contradict."""
    suffix, stages = Path(options.output or "table.csv").suffix.lower(), list[int]()
    if suffix not in WRITERS:
        raise OptionError(f"{options.output}: {wrong_suffix(options.output, WRITERS, 'outputs')}")
    writer = WRITERS[suffix]
    if options.strip is not None:
        refusal = "strip has {}; give numbers of iterations, such as 0,10,50"
        stages = sorted(set(relax_options.listed(options.strip, 0, refusal)))
    if stages and writer is not write_figure:
        place = "-o" if options.output is None else options.output
        raise OptionError(f"{place}: a strip is a picture; let OUT end in .png or .svg, or leave --strip out")
    if writer is write_figure:
        figure_class("or write .csv or .json")
        writer = partial(write_strip, stages) if stages else writer
    return writer, stages


def methods(_options: argparse.Namespace) -> int:
    if width_of(sys.stdout) is None:
        emit("\n".join(f"{name}\t{method.sentence}" for name, method in METHODS.items()))
    else:
        emit(table(("method", "what it is"), [(name, method.sentence) for name, method in METHODS.items()], sys.stdout))
    return 0


def _write_json(path: Path, runs: Sequence[History]) -> None:
    names = [each.name for each in fields(History) if each.name != "stages"]
    plain = [{name: getattr(run, name) for name in names} for run in runs]
    path.write_text(json.dumps(plain, indent=1) + "\n", encoding="utf-8")


def _write_csv(path: Path, runs: Sequence[History]) -> None:
    with path.open("w", encoding="utf-8", newline="") as stream:
        table = csv.writer(stream)
        table.writerow(["method", "status", "iteration", "seconds", "energy", "gradient_norm", "fallback", "metric"])
        for run in runs:
            rows = enumerate(zip(run.seconds, run.energy, run.gradient_norm, strict=True))
            each = ([run.method, run.status, k, *values, int(k in run.fallback), run.metric] for k, values in rows)
            table.writerows(each)


WRITERS: Mapping[str, Writer] = {".png": write_figure, ".svg": write_figure, ".csv": _write_csv, ".json": _write_json}
