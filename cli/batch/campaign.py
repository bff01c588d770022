"""A batch from its inputs to its table."""

import argparse
import sys
from pathlib import Path

from ...core import RelaxOptions
from ...core.errors import OutputError
from .. import signals
from . import cluster
from .folder import check_replaceable, finished, sweep
from .inputs import inputs
from .job import Job, jobs
from .progress import Progress
from .table import Row, Table


def campaign(options: argparse.Namespace, wanted: RelaxOptions) -> Table:
    """Do the runs that are not finished; the table is written in the end, also of an interrupted batch."""
    cluster.require()
    directory = Path(options.output).resolve()
    planned = jobs(inputs(options.inputs), options.starts, options.seed, directory, wanted, options.extrapolate)
    _prepare(directory, planned)
    known = [(job, finished(job)) for job in planned]
    rows, left = [row for _, row in known if row], [job for job, row in known if row is None]
    if left:
        _run(left, rows, directory, options)
    else:
        Table(rows).save(directory)
    return Table(rows)


def _prepare(directory: Path, planned: list[Job]) -> None:
    """Make the directory; what is in the way of results is told before any work."""
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(directory, error) from error
    for job in planned:
        check_replaceable(Path(job.folder))


def _run(left: list[Job], rows: list[Row], directory: Path, options: argparse.Namespace) -> None:
    """Add the rows of runs as they come, and write the table of those that there are in the end."""
    shown = not options.quiet and sys.stderr.isatty()
    with cluster.connected(options.scheduler) as client, Progress(client, len(left), shown) as progress:
        try:
            for row in cluster.rows(client, left, options.time_limit):
                rows.append(row)
                progress.show(row)
        finally:
            signals.hold()  # the table is neither lost nor halved
            Table(rows).save(directory)
    sweep(directory)
