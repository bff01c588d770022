"""A batch from its inputs to its table: on this machine's cores, or on a running Dask cluster."""

import argparse
import asyncio
import logging
import os
import queue
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import CancelledError, ThreadPoolExecutor
from contextlib import contextmanager
from functools import partial
from itertools import islice
from pathlib import Path
from typing import Any

from ...cli import options as relax_options
from ...cli import signals
from ...cli.places import check_place
from ...cli.progress import live
from ...cli.terminal import GREEN, YELLOW, command, emit, quoted, report, table
from ...core import MobiusFlowError
from ...core.base.errors import OptionError, OutputError, counted
from . import sandbox
from .dask import import_distributed
from .folder import check_replaceable, finished, sweep
from .job import CSV, PARQUET, Job, Plan, folder_name, inputs, jobs
from .table import FAILED, Row, check_tables, in_order, save

Submit = Callable[..., Any]  # of a function and its arguments; gives a future

WINDOW = 1000  # runs submitted at a time: enough for hundreds of cores, and little memory
_PATIENCE = 4.0  # seconds for the scheduler to answer


def require(address: str | None) -> None:
    """Raise a MobiusFlowError that says what to install if a library is missing."""
    try:
        import pyarrow  # noqa: F401

        if address is not None:
            import_distributed()
    except ImportError as error:
        raise MobiusFlowError(
            f"batch needs pyarrow, and for a scheduler dask.distributed: {error}; "
            'install them with pip install "dask[distributed]" "pyarrow<26", or in a clone pip install ".[lab]"'
        ) from error


@contextmanager
def submitting(address: str | None) -> Iterator[Submit]:
    """A function that submits to a scheduler, or to all cores of this machine; a MobiusFlowError if nobody answers."""
    if address is None:  # a thread for each core, with a child process of its own
        cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
        pool = ThreadPoolExecutor(cores)
        try:
            yield pool.submit
        finally:
            with sandbox.closed():  # threads wait for their children
                pool.shutdown(cancel_futures=True)
        return
    from distributed import Client
    from distributed.comm.core import connect
    from distributed.security import Security

    async def greet() -> None:
        """Connect and disconnect; a client that cannot connect would be half made, and hang when it is collected."""
        comm = await connect(address, timeout=_PATIENCE, **Security().get_connection_args("client"))
        await comm.close()

    for name in ("distributed", "distributed.client"):
        logging.getLogger(name).setLevel(logging.CRITICAL)  # rows report what goes wrong
    try:
        asyncio.run(asyncio.wait_for(greet(), _PATIENCE))  # a peer may take the call and say nothing
        client = Client(address, timeout=_PATIENCE)
    except (OSError, ValueError, TypeError) as error:  # TypeError: where TLS is not set up
        raise MobiusFlowError(f"{address}: no Dask scheduler answers there") from error
    with client:
        try:
            client.wait_for_workers(1, timeout=30.0)
        except TimeoutError as error:
            raise MobiusFlowError(f"{address}: no worker has joined in 30 s") from error
        yield partial(client.submit, pure=False)


def outcomes(submit: Submit, jobs: Iterable[Job]) -> Iterator[tuple[Job, Row]]:
    """Do all runs, and yield each with its row as they finish; a MobiusFlowError says why the others cannot be done."""
    waiting, under_way, ended = iter(jobs), dict[Any, tuple[Job, int]](), queue.SimpleQueue[Any]()

    def begin(job: Job, tries: int = 1) -> None:
        future = submit(sandbox.run, job)
        under_way[future] = job, tries
        future.add_done_callback(ended.put)

    for job in islice(waiting, WINDOW):
        begin(job)
    while under_way:
        try:
            # 0.5: seconds after which an interrupt is noticed where waiting is not interruptible, as on Windows
            future = ended.get(timeout=0.5)
        except queue.Empty:
            continue
        job, tries = under_way.pop(future)
        try:
            row = future.result()
        except (CancelledError, OSError) as lost:  # an OSError where a row cannot be fetched
            raise MobiusFlowError("the Dask scheduler is lost; give the same command again to go on") from lost
        except MobiusFlowError:
            raise
        except sandbox.ChildDiedError as error:
            if tries < 3:
                begin(job, tries + 1)
                continue
            row = Row.failure(job, f"{tries} tries failed: {error}")
        except Exception as error:  # of the cluster: workers that die, or lack the program
            row = Row.failure(job, str(error))
        yield job, row
        for another in islice(waiting, 1):
            begin(another)


def campaign(options: argparse.Namespace) -> int:
    """Do the unfinished runs, write the table, even if the batch is interrupted, and print what was found."""
    if not options.output:
        raise OptionError("output is empty; name the directory of the results")
    most_starts, most_rows = 10**9, 100  # more than there is time for, and than anyone reads
    if not 1 <= options.starts <= most_starts:
        raise OptionError(f"starts is {options.starts}; it must be from 1 to {most_starts}")
    if options.tighten and options.extrapolate:
        raise OptionError("knots that are pulled tight have no energy to --extrapolate; leave one of both out")
    wanted = relax_options.from_arguments(options)
    require(options.scheduler)
    directory = Path(options.output).resolve()
    pins = [pin for text in options.pins for pin in relax_options.pinned(text)]
    still = {"avoid": options.avoid, "pins": pins, "pin_tangents": options.pin_tangents}
    words = inputs(options.inputs)
    plan = jobs(words, options.starts, directory, wanted, still, options.extrapolate, options.tighten)
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
    measure, digits = ("ropelength", 7) if options.tighten else ("energy", 5)
    cells = [
        (
            folder_name(row.name, row.start),
            row.type_after or "",
            "" if (found := getattr(row, measure)) is None else f"{found:.{digits}g}",
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
    shown = table(("name", "type", measure, "certified", "s", "how it ended"), cells, sys.stdout)
    emit(f"{shown}\n\n{report(head, below, sys.stdout, colour)}")
    return 0


def _found(plan: Plan) -> dict[Job, Row]:
    """The rows of the runs that are finished."""
    return {job: row for job in plan.standing() if (row := finished(job)) is not None}


def _run(plan: Plan, rows: dict[Job, Row], directory: Path, options: argparse.Namespace) -> None:
    """Add the rows of runs as they come, and write the table of all of them in the end."""
    before, failed = frozenset(rows), 0
    with submitting(options.scheduler) as submit, live(not options.quiet) as show:
        if not options.quiet:
            done = f", of which {len(rows):,} are finished" if rows else ""
            print(f"{len(plan):,} run{'s' * (len(plan) > 1)}{done}", file=sys.stderr, flush=True)
        try:
            for job, row in outcomes(submit, (job for job in plan if job not in before)):
                rows[job] = row
                failed += row.failed
                show(f"{len(rows):,} of {len(plan):,} runs · {failed} failed · last: {Path(job.folder).name}")
        finally:
            signals.hold()  # the table is neither lost nor halved
            rows |= {job: row for job, row in _found(plan).items() if job not in rows}  # those still on their way
            save(rows.values(), directory)
    sweep(directory)
