"""A batch from its inputs to its table."""

import argparse
import os
import sys
from collections import Counter
from pathlib import Path

from ...cli import options as relax_options
from ...cli import signals
from ...cli.places import check_place
from ...cli.progress import live
from ...cli.terminal import GREEN, YELLOW, command, emit, quoted, report, table
from ...core.base.errors import OptionError, OutputError, counted
from . import cluster
from .folder import check_replaceable, finished, sweep
from .job import CSV, PARQUET, Job, Plan, folder_name, inputs, jobs
from .table import FAILED, Row, check_tables, in_order, save


def campaign(options: argparse.Namespace) -> int:
    """Do the unfinished runs, write the table, even if the batch is interrupted, and print what was found."""
    if not options.output:
        raise OptionError("output is empty; name the directory of the results")
    most_starts, most_rows = 10**9, 100  # more than there is time for, and than anyone reads
    if not 1 <= options.starts <= most_starts:
        raise OptionError(f"starts is {options.starts}; it must be from 1 to {most_starts}")
    wanted = relax_options.from_arguments(options)
    cluster.require(options.scheduler)
    directory = Path(options.output).resolve()
    pins = [pin for text in options.pins for pin in relax_options.pinned(text)]
    still = {"avoid": options.avoid, "pins": pins, "pin_tangents": options.pin_tangents}
    plan = jobs(inputs(options.inputs), options.starts, directory, wanted, still, options.extrapolate)
    rows = _found(plan)
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(directory, error) from error
    for name in (CSV, PARQUET):  # obstacles to the results are reported before any work
        check_place(str(directory / name))
    check_tables(directory)
    for folder in {*(directory / folder_name(name, k) for name in plan.inputs for k in {1, plan.starts})} | {
        Path(job.folder) for job in plan.standing() if job not in rows
    }:
        check_replaceable(folder)
    if len(rows) == len(plan):
        save(rows.values(), directory)
    else:
        _run(plan, rows, directory, options)
    if options.quiet:
        return 0
    cells = [
        (
            folder_name(row.name, row.start),
            row.type_after or "",
            "" if row.energy is None else f"{row.energy:.5g}",
            "" if row.certified is None else "yes" if row.certified else "NO",
            "" if row.seconds is None else f"{row.seconds:.1f}",
            row.message if row.failed else row.status.replace("_", " "),
        )
        for row in in_order(rows.values())[:most_rows]
    ]
    ends = Counter(row.status.replace("_", " ") for row in in_order(rows.values()))
    mark, colour = ("–", YELLOW) if ends[FAILED] else ("✓", GREEN)
    head = f"{mark} {counted(len(rows), 'run')}", ", ".join(f"{count} {end}" for end, count in ends.most_common())
    below = [
        ("shown", f"the first {most_rows}; all are in the table that is written" if len(rows) > most_rows else ""),
        ("wrote", [quoted(os.path.join(options.output, name)) for name in (CSV, PARQUET)]),
        ("next", [command("gallery", options.output, "-o", "gallery.png")]),
    ]
    found = table(("name", "type", "energy", "certified", "s", "how it ended"), cells, sys.stdout)
    emit(f"{found}\n\n{report(head, below, sys.stdout, colour)}")
    return 0


def _found(plan: Plan) -> dict[Job, Row]:
    """The rows of the runs that are finished."""
    return {job: row for job in plan.standing() if (row := finished(job)) is not None}


def _run(plan: Plan, rows: dict[Job, Row], directory: Path, options: argparse.Namespace) -> None:
    """Add the rows of runs as they come, and write the table of all of them in the end."""
    before, failed = frozenset(rows), 0
    with cluster.submitting(options.scheduler) as submit, live(not options.quiet) as show:
        if not options.quiet:
            done = f", of which {len(rows):,} are finished" if rows else ""
            print(f"{len(plan):,} run{'s' * (len(plan) > 1)}{done}", file=sys.stderr, flush=True)
        try:
            for job, row in cluster.rows(submit, (job for job in plan if job not in before)):
                rows[job] = row
                failed += row.failed
                show(f"{len(rows):,} of {len(plan):,} runs · {failed} failed · last: {Path(job.folder).name}")
        finally:
            signals.hold()  # the table is neither lost nor halved
            rows |= {job: row for job, row in _found(plan).items() if job not in rows}  # those still on their way
            save(rows.values(), directory)
    sweep(directory)
