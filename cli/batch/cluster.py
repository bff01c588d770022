"""Runs on a Dask cluster: this machine's cores, or one that is running already."""

import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from itertools import islice
from typing import TYPE_CHECKING

from ...core import MobiusFlowError
from . import sandbox
from .job import Job
from .table import Row

if TYPE_CHECKING:
    from distributed import Client, Future

WINDOW = 1000  # runs that the scheduler knows of at a time: enough for hundreds of cores, and little memory
TRIES = 3  # of a run whose process dies
_PATIENCE = 60.0  # seconds for the first worker to join
_CONFIG = {
    "logging.distributed": "critical",  # what matters is told by rows
    "distributed.dashboard.link": "http://{host}:{port}/status",
    "distributed.comm.timeouts.connect": "10s",
}


def require() -> None:
    """Raise a MobiusFlowError that says what to install if a library is missing."""
    try:
        import distributed  # noqa: F401
        import pyarrow  # noqa: F401
    except ImportError as error:
        raise MobiusFlowError(
            f"batch needs dask.distributed and pyarrow, which cannot be loaded: {error}; "
            'install them with pip install "dask[distributed]" "pyarrow<26", or in a clone pip install ".[cluster]"'
        ) from error


@contextmanager
def connected(address: str | None) -> "Iterator[Client]":
    """A client of the scheduler at an address, or of one for all cores of this machine.

    A MobiusFlowError says if there is no scheduler, or no worker.
    """
    import dask
    from distributed import Client, LocalCluster

    with dask.config.set(_CONFIG):
        if address is not None:
            with _joined(address) as client:
                yield client
            return
        # threads, as each has a child process: a kill ends one run, and there is one process per core
        cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
        with (
            LocalCluster(
                n_workers=1, threads_per_worker=cores, processes=False, memory_limit=0, dashboard_address="127.0.0.1:0"
            ) as cluster,
            Client(cluster) as client,
        ):
            try:
                yield client
            finally:
                sandbox.close_all()  # threads that wait for a child would keep the cluster


@contextmanager
def _joined(address: str) -> "Iterator[Client]":
    from distributed import Client

    try:
        client = Client(address)
    except (OSError, ValueError) as error:
        raise MobiusFlowError(f"{address}: no Dask scheduler answers there") from error
    with client:
        try:
            client.wait_for_workers(1, timeout=_PATIENCE)
        except TimeoutError as error:
            raise MobiusFlowError(f"{address}: no worker has joined in {_PATIENCE:.0f} s") from error
        yield client


def rows(client: "Client", jobs: Iterable[Job], limit: float | None) -> Iterator[Row]:
    """Do all runs, and give their rows as they come; a window of them at a time is on the cluster."""
    from distributed import as_completed

    waiting, under_way = iter(jobs), dict[object, Job]()

    def submitted(count: int) -> "Iterator[Future[Row]]":
        for job in islice(waiting, count):
            future = client.submit(sandbox.run, job, limit, pure=False, retries=TRIES - 1)
            under_way[future.key] = job
            yield future

    completed = as_completed(submitted(WINDOW))
    for future in completed:
        yield _row(under_way.pop(future.key), future)
        completed.update(list(submitted(1)))


def _row(job: Job, future: "Future[Row]") -> Row:
    error = future.exception()
    if error is None:
        row: Row = future.result()
        return row
    tries = f"{TRIES} tries failed: " if isinstance(error, sandbox.ChildDiedError) else ""
    return Row.failure(job, f"{tries}{error}")
