"""Runs on a Dask cluster: this machine's cores, or one that is running already."""

import asyncio
import logging
import os
from collections.abc import Iterable, Iterator
from concurrent.futures import CancelledError
from contextlib import AbstractContextManager, contextmanager
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
_LOGS = "distributed", "distributed.client"
_PATIENCE = 30.0  # seconds for the scheduler to answer, and for the first worker to join


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


def connected(address: str | None) -> "AbstractContextManager[Client]":
    """A client of the scheduler at an address, or of one for all cores of this machine.

    A MobiusFlowError says if there is no scheduler, or no worker.
    """
    for name in _LOGS:
        logging.getLogger(name).setLevel(logging.CRITICAL)  # rows tell what goes wrong
    return _own() if address is None else _joined(address)


@contextmanager
def _own() -> "Iterator[Client]":
    """Threads of this process, since each has a child process: one per core, and a kill ends one run."""
    import dask
    from distributed import Client, LocalCluster

    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    size = {"n_workers": 1, "threads_per_worker": cores, "memory_limit": 0}
    with (
        dask.config.set({"distributed.dashboard.link": "http://127.0.0.1:{port}/status"}),
        LocalCluster(processes=False, dashboard_address="127.0.0.1:0", **size) as cluster,
    ):
        try:
            with Client(cluster) as client:
                yield client
        finally:
            sandbox.close_all()  # threads that wait for a child would keep the cluster


@contextmanager
def _joined(address: str) -> "Iterator[Client]":
    from distributed import Client

    try:
        asyncio.run(asyncio.wait_for(_greet(address), _PATIENCE))  # a peer may take the call and say nothing
        client = Client(address, timeout=_PATIENCE)
    except (OSError, ValueError, TypeError) as error:  # TypeError: where TLS is not set up
        raise MobiusFlowError(f"{address}: no Dask scheduler answers there") from error
    with client:
        try:
            client.wait_for_workers(1, timeout=_PATIENCE)
        except TimeoutError as error:
            raise MobiusFlowError(f"{address}: no worker has joined in {_PATIENCE:.0f} s") from error
        yield client


async def _greet(address: str) -> None:
    """Connect and part; a client that cannot connect would be left half made, and hang when it is collected."""
    from distributed.comm.core import connect
    from distributed.security import Security

    comm = await connect(address, timeout=_PATIENCE, **Security().get_connection_args("client"))
    await comm.close()


def rows(client: "Client", jobs: Iterable[Job], limit: float | None) -> Iterator[tuple[Job, Row]]:
    """Do all runs, and give each with its row as they come; a window of them at a time is on the cluster."""
    from distributed import as_completed

    waiting, under_way = iter(jobs), dict[object, Job]()

    def submitted(count: int) -> "Iterator[Future[Row]]":
        for job in islice(waiting, count):
            future = client.submit(sandbox.run, job, limit, pure=False, retries=TRIES - 1)
            under_way[future.key] = job
            yield future

    completed = as_completed(submitted(WINDOW))
    for future in completed:
        job = under_way.pop(future.key)
        yield job, _row(job, future)
        completed.update(list(submitted(1)))


def _row(job: Job, future: "Future[Row]") -> Row:
    try:
        row: Row = future.result()
    except CancelledError as lost:
        raise MobiusFlowError("the Dask scheduler is lost; give the same command again to go on") from lost
    except sandbox.ChildDiedError as error:
        return Row.failure(job, f"{TRIES} tries failed: {error}")
    except Exception as error:  # of the cluster: workers that die, or lack the program
        return Row.failure(job, str(error))
    return row
