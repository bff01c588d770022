"""Runs in child processes, one for each thread that asks, so that a hang, crash or kill affects one run only.

A child lives on from run to run, since NumPy and SciPy take half a second to import. It runs this module: a line of
JSON for each job in, one for its row out, until there is no parent.
"""

import json
import os
import queue
import signal
import subprocess
import sys
import threading
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import asdict
from weakref import WeakSet

from ...core import MobiusFlowError
from ...core.base.errors import OutputError
from .job import Job
from .table import Row

PATIENCE, GRACE = 2.0, 60.0  # times its time limit, plus seconds: a run that takes longer hangs, and is killed
_READY, _REFUSED = "ready", "refused"
_own = threading.local()
_open: "WeakSet[Sandbox]" = WeakSet()
_closed = threading.Event()


class ChildDiedError(Exception):
    """A child ended without an answer."""


class Sandbox:
    """A child process that does one run at a time."""

    def __init__(self) -> None:
        try:
            self._process = subprocess.Popen(
                [sys.executable, "-P", "-m", __name__],  # modules in the working directory are not its own
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                encoding="utf-8",
                start_new_session=True,  # Ctrl-C is for the parent
            )
        except OSError as error:
            raise ChildDiedError(f"its process cannot be started: {error}") from error
        _open.add(self)
        if _closed.is_set():
            self.close()
        self._answer()  # it is ready, or there would be an error

    def run(self, job: Job) -> Row:
        """The row of a run, which is killed if it goes on long after its time limit.

        Raises ChildDiedError if there is none, so that another sandbox is needed, and MobiusFlowError if results cannot
        be written.
        """
        seconds = min(GRACE + PATIENCE * job.time_limit, threading.TIMEOUT_MAX)
        watchdog, began = threading.Timer(seconds, self._process.kill), time.monotonic()
        watchdog.start()
        try:
            answer = json.loads(self._answer(json.dumps(asdict(job))))
        except ChildDiedError:
            if time.monotonic() - began < seconds:
                raise
            return Row.failure(job, f"stopped after {seconds:g} s, long after its time limit")
        finally:
            watchdog.cancel()
        if _REFUSED in answer:
            raise MobiusFlowError(answer[_REFUSED])
        return Row(**answer)

    def close(self) -> None:
        """End the child, and the run under way."""
        self._process.kill()
        with suppress(OSError, ValueError):  # a thread may be reading, or have closed the pipes: before, or meanwhile
            self._process.communicate()

    @property
    def ended(self) -> bool:
        return self._process.poll() is not None

    def _answer(self, line: str = "") -> str:
        """The child's next line, after sending it one."""
        process = self._process
        assert process.stdin is not None, "it is a pipe"
        assert process.stdout is not None, "it is a pipe"
        try:
            if line:
                print(line, file=process.stdin, flush=True)
            answer = process.stdout.readline()
        except (OSError, ValueError):  # a ValueError for a pipe that was closed meanwhile
            answer = ""
        if not answer.endswith("\n"):
            self.close()
            code, ended = process.returncode, f"ended with status {process.returncode}"
            if code < 0:
                ended = f"was killed by signal {-code}"
                with suppress(ValueError):
                    ended = f"was killed by {signal.Signals(-code).name}"
            raise ChildDiedError(f"its process {ended}")
        return answer


def run(job: Job) -> Row:
    """Do a run in the child of this thread; raises as `Sandbox.run` does."""
    box: Sandbox | None = getattr(_own, "box", None)
    if box is None or box.ended:
        box = _own.box = Sandbox()
    return box.run(job)


@contextmanager
def closed() -> Iterator[None]:
    """End all children of this process, including those that threads start in the block."""
    _closed.set()
    try:
        for box in list(_open):
            box.close()
        yield
    finally:
        _closed.clear()


def _serve() -> None:
    """Answer jobs for ever; only the end of standard input ends it."""
    lines: queue.SimpleQueue[str] = queue.SimpleQueue()
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8", buffering=1)
    os.dup2(2, 1)  # output of libraries is no answer
    warnings.simplefilter("ignore")

    def listen() -> None:
        for line in sys.stdin:
            lines.put(line)
        os._exit(0)  # the parent's end, even a sudden one, is noticed at once and ends the work under way

    threading.Thread(target=listen, daemon=True).start()
    from .single import relaxed

    print(_READY, file=answers)
    while True:
        try:
            answer = vars(relaxed(Job(**json.loads(lines.get()))))
        except OutputError as error:
            answer = {_REFUSED: f"{error}; once that is fixed, give the same command again to go on"}
        print(json.dumps(answer), file=answers)


if __name__ == "__main__":
    _serve()
