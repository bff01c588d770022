"""Ctrl-C, SIGTERM and SIGHUP interrupt the work, and wait while results are written.

The first signal raises KeyboardInterrupt; from then on, and wherever `hold` was called, signals wait until `allow`. So
neither a second signal nor one at an odd moment costs the results of a run.
"""

import contextlib
import math
import os
import signal
import threading
import time
from collections.abc import Generator, Iterator
from types import FrameType
from typing import Any, TypeVar, cast

_Item = TypeVar("_Item")
_Result = TypeVar("_Result")

INTERRUPTED = 130


class _State:
    """What the next signal does, whether one is waiting, and when the last one was raised."""

    mode = "raise"  # or "hold", or "leave" the process
    waiting = False
    raised = -math.inf  # by the monotonic clock
    together = 1.0  # seconds in which signals count as one: a terminal and a parent process often send one each


def hold() -> None:
    _State.mode = "hold"


def allow() -> None:
    """Let signals interrupt again, starting with one that has been waiting."""
    _State.mode = "raise"
    if _State.waiting:
        _interrupt()


def interruptible(work: Generator[_Item, None, _Result]) -> Generator[_Item, None, _Result]:
    """The same items, interrupted by signals while they are computed, and only then."""
    while True:
        allow()
        try:
            item = next(work)
        except StopIteration as end:
            hold()
            return cast(_Result, end.value)
        hold()
        yield item


@contextlib.contextmanager
def raised() -> Iterator[None]:
    """Let signals raise KeyboardInterrupt in a block; those that are ignored or handled by others are left alone."""
    mode, previous = _State.mode, _install()
    _State.mode, _State.waiting, _State.raised = "raise", False, -math.inf
    try:
        yield
    finally:
        _State.mode = mode
        for number, handler in previous.items():
            signal.signal(number, handler)


def leave_at_once() -> None:
    """Let signals end the process with one sentence as long as there is nothing to lose, such as during imports."""
    _State.mode = "leave"
    _install()


def _install() -> dict[int, Any]:
    if threading.current_thread() is not threading.main_thread():
        return {}
    numbers = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
    unset = (signal.SIG_DFL, signal.default_int_handler)  # neither ignored, as by nohup, nor someone else's
    return {number: signal.signal(number, _receive) for number in numbers if signal.getsignal(number) in unset}


def _receive(_number: int, _frame: FrameType | None) -> None:
    if time.monotonic() - _State.raised < _State.together:
        return
    if _State.mode == "raise":
        _interrupt()
    if _State.mode == "leave":
        _State.mode = "hold"  # one sentence, even if another signal comes now
        with contextlib.suppress(OSError):
            os.write(2, b"mobius-flow: interrupted\n")
        os._exit(INTERRUPTED)
    _State.waiting = True


def _interrupt() -> None:
    _State.mode, _State.waiting, _State.raised = "hold", False, time.monotonic()
    raise KeyboardInterrupt
