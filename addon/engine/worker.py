"""Both ends of the worker: what it does in its process, and how Blender starts it, takes in its iterates and ends it.

Blender never waits for it, and ends it at once. What they tell each other is pickled: both run the same files.
"""

import contextlib
import inspect
import math
import os
import pickle
import queue
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator, Mapping
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import scipy
import threadpoolctl

from ...core import Curve, Hand, Iterate, MobiusFlowError, Outcome, RelaxOptions, Task, WithOutcome, relax
from ...core.base import Message, TimeIsUp, TimeLimit
from ...core.driver import Relaxation
from ...core.driver.morph import morphing
from ...core.driver.outcome import INTERRUPTED
from ...core.ropes import SeparateOptions, TightenOptions, separating, tightening

Inbox = queue.Queue[Any]
STOP = ("stop", ())


class Stop(TimeLimit):
    """The time is up as soon as the inbox holds a stop."""

    def __init__(self, inbox: Inbox) -> None:
        super().__init__(math.inf)
        self._inbox = inbox

    @property
    def is_reached(self) -> bool:
        with self._inbox.mutex:
            return STOP in self._inbox.queue


def messages(inbox: Inbox) -> Iterator[Any]:
    """Yield the iterates of a job, and at last the outcome or an error.

    The inbox holds the job first, what `Worker` is given, and then pauses and actions of the hand, read between steps;
    a stop ends the present one and gives what was reached, None ends it all.
    """
    job = inbox.get()
    if job is None:
        return
    task, options, stays, goals = job
    hand, paused = Hand(stays=stays), False
    try:
        run, stop = WithOutcome(begun(task, options, goals, hand)), Stop(inbox)
        steps = iter(run)
        while run.outcome is None:
            with stop:
                iterate = next(steps, None)
            if iterate is not None:
                yield iterate
            while (paused or hand.rests or not inbox.empty()) and not stop.is_reached:
                if (said := inbox.get()) is None:
                    return
                if said == STOP:  # which came while it waited
                    raise TimeIsUp(stop)
                deed, facts = said
                if deed == "pause":
                    (paused,) = facts
                else:
                    getattr(hand, deed)(*facts)
        yield run.outcome
    except TimeIsUp as up:
        yield INTERRUPTED.noting(up)
    except MobiusFlowError as error:
        yield error


Job = RelaxOptions | SeparateOptions | TightenOptions


def begun(task: Task, options: Job, goals: Mapping[str, Curve], hand: Hand) -> Relaxation:
    """The relaxation of a task, which a hand may drag, its motion to goals, one after the other, or what else to do."""
    if isinstance(options, SeparateOptions):
        return separating(task, options)
    if isinstance(options, TightenOptions):
        return tightening(task, options)
    if not goals:
        return relax(task, options, hand)
    return morphing(
        (task, *map(Task.of, goals.values())), options, (Message("the curve that moves"), *map("'{}'".format, goals))
    )


class WorkerError(MobiusFlowError):
    """The worker ended without saying why."""


class Worker:
    """A relaxation in another process, or in a thread where no process can be started.

    ``stays``: as for `Hand`; ``goals``: as for `begun`.
    """

    def __init__(
        self, task: Task, options: Job, stays: bool = False, goals: Mapping[str, Curve] = MappingProxyType({})
    ) -> None:
        self._inbox: Inbox = queue.Queue()
        self._inbox.put((task, options, stays, dict(goals)))
        self._queue: queue.Queue[Any] = queue.Queue(64)  # wait while Blender draws; then the worker does
        self._closed = threading.Event()
        self.process = _start()
        self._thread = threading.Thread(target=self._feed, name="Möbius Flow", daemon=True)
        self._thread.start()
        if self.process is not None:
            threading.Thread(target=_send, args=(self.process, self._inbox), daemon=True).start()

    def tell(self, deed: str, *facts: Any) -> None:
        """Have the hand do something as soon as the present step is done: a method of `Hand`, by its name.

        ``pause`` is for the worker itself: whether it waits there; so is ``stop``, which does not wait for the step.
        """
        self._inbox.put((deed, facts))

    def poll(self) -> Iterate | Outcome | None:
        """Take the next iterate if there is one; after the last one comes the outcome.

        Raises MobiusFlowError if the curve cannot be relaxed, or the worker is gone.
        """
        try:
            message = self._queue.get_nowait()
        except queue.Empty:
            return None
        if message is None:
            raise WorkerError(Message("The computation ended unexpectedly; memory may have run out"))
        if isinstance(message, MobiusFlowError):
            raise message
        return message  # type: ignore[no-any-return]

    def close(self) -> None:
        """End the process now and the thread with it; harmless to repeat."""
        self._closed.set()
        self._inbox.put(None)
        if self.process is not None:
            self.process.kill()
            self.process.wait()
            self._thread.join(timeout=0.2)  # its streams belong to the thread, which may be waiting for room

    def _feed(self) -> None:
        """Pass messages on until there are no more or nobody wants them, and None at last."""
        pipe = None if self.process is None else self.process.stdout
        replies = messages(self._inbox) if pipe is None else iter(partial(pickle.load, pipe), None)
        try:
            with contextlib.suppress(EOFError, OSError, ValueError, pickle.UnpicklingError):  # the process is gone
                for message in replies:
                    self._put(message)
                    if self._closed.is_set():
                        break
        finally:
            self._put(None)
            if pipe is not None:
                pipe.close()

    def _put(self, message: Any) -> None:
        while not self._closed.is_set():
            with contextlib.suppress(queue.Full):
                self._queue.put(message, timeout=0.1)  # seconds, and then see whether anybody still wants it
                break


def _send(process: "subprocess.Popen[bytes]", inbox: Inbox) -> None:
    """Pass on what is put into the inbox, in a thread of its own: a pipe may be full."""
    if hasattr(signal, "pthread_sigmask"):  # or else a worker that is gone ends a Blender that does not ignore SIGPIPE
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGPIPE})
    assert process.stdin is not None, "it was started with a pipe"
    with contextlib.suppress(OSError), process.stdin as pipe:  # to a worker that is gone
        for packet in iter(inbox.get, None):
            pickle.dump(packet, pipe)
            pipe.flush()


def _start() -> "subprocess.Popen[bytes] | None":
    """Start the worker's process with Blender's own Python; None if there is none or it does not start."""
    # In Blender this is the Python it comes with. Should a build put Blender itself here, -P would mean something else.
    if not Path(sys.executable or "").name.lower().startswith("python"):
        return None
    program = Path(__file__).with_name("child.py")
    libraries = [Path(inspect.getfile(module)) for module in (scipy, np, threadpoolctl)]
    places = dict.fromkeys(str(file.parents[file.stem == "__init__"]) for file in libraries)
    try:
        return subprocess.Popen(
            [sys.executable, "-P", "-s", str(program), __package__],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(places)},
            creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
        )
    except OSError:
        return None
