"""A batch from its inputs to its table."""

import argparse
import os
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from ...core.errors import OptionError, OutputError
from .. import options as relax_options
from .. import signals
from ..places import check_place
from ..progress import bar
from ..streams import emit
from . import cluster
from .folder import check_replaceable, finished, sweep
from .job import CSV, PARQUET, Job, inputs, jobs
from .table import Row, check_tables, save, summary


def campaign(options: argparse.Namespace) -> None:
    """Do the unfinished runs, write the table, even if the batch is interrupted, and print a line about it."""
    if not options.output:
        raise OptionError("output is empty; name the directory of the results")
    if options.starts < 1:
        raise OptionError(f"starts is {options.starts}; it must be 1 or more")
    wanted = relax_options.from_arguments(options)
    cluster.require(options.scheduler)
    directory = Path(options.output).resolve()
    pins = [pin for text in options.pins for pin in relax_options.pinned(text)]
    still = {"avoid": options.avoid, "pins": pins, "pin_tangents": options.pin_tangents}
    planned = jobs(inputs(options.inputs), options.starts, directory, wanted, still, options.extrapolate)
    rows = _found(planned)
    left = [job for job in planned if job not in rows]
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(directory, error) from error
    for name in (CSV, PARQUET):  # obstacles to the results are reported before any work
        check_place(str(directory / name))
    check_tables(directory)
    for job in left:
        check_replaceable(Path(job.folder))
    if left:
        _run(left, rows, directory, options)
    else:
        save(rows.values(), directory)
    if not options.quiet:
        failed = any(row.failed for row in rows.values())
        why = f"; {os.path.join(options.output, CSV)} says why" if failed else ""
        emit(summary(rows.values()) + why)


def _found(planned: Iterable[Job]) -> dict[Job, Row]:
    """The rows of the runs that are finished."""
    return {job: row for job in planned if (row := finished(job)) is not None}


def _run(left: list[Job], rows: dict[Job, Row], directory: Path, options: argparse.Namespace) -> None:
    """Add the rows of runs as they come, and write the table of all of them in the end."""
    shown = not options.quiet and sys.stderr.isatty()
    with (
        cluster.submitting(options.scheduler) as submit,
        bar(shown, total=len(left), unit="run", smoothing=0.1) as progress,
    ):
        try:
            for job, row in cluster.rows(submit, left):
                rows[job] = row
                _show(progress, rows)
        finally:
            signals.hold()  # the table is neither lost nor halved
            rows |= _found(job for job in left if job not in rows)  # rows that were still on their way
            save(rows.values(), directory)
    sweep(directory)


def _show(progress: Any, rows: Mapping[Job, Row]) -> None:
    """Count another run that has ended, and the failed ones."""
    if progress is not None:
        progress.set_postfix_str(f"{sum(row.failed for row in rows.values())} failed", refresh=False)
        progress.update()
