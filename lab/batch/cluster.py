"""Where the runs of a batch are done: on this machine's cores, or on a running Dask cluster."""

import asyncio
import logging
import os
import queue
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import CancelledError, ThreadPoolExecutor
from contextlib import contextmanager
from functools import partial
from itertools import islice
from typing import Any

from ...core import MobiusFlowError
from . import sandbox
from .dask import import_distributed
from .job import Job
from .table import Row

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


def rows(submit: Submit, jobs: Iterable[Job]) -> Iterator[tuple[Job, Row]]:
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
