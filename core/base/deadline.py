"""Work that ends early: at a time limit, which is checked wherever a step may take long, or at a signal."""

import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar, Token
from types import FrameType
from typing import NoReturn

_SIGNALS = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]


class TimeIsUp(Exception):  # noqa: N818 (no error: what was reached is kept)
    """Leaves a step whose time is up; ``limit`` is the one that was reached."""

    def __init__(self, limit: "TimeLimit") -> None:
        super().__init__("the time is up")
        self.limit = limit


class TimeLimit:
    """A stopwatch that runs in ``with`` blocks, and whose limit in seconds `check_time` observes there.

    Like NumPy's error state it belongs to the context: those who look at it need not be handed it.  The clock is
    `time.perf_counter`, or `time.process_time` where a busy machine is not to decide; ``used`` are the seconds used so
    far.
    """

    def __init__(self, seconds: float, clock: Callable[[], float] = time.perf_counter, used: float = 0.0) -> None:
        self.seconds, self.used = seconds, used
        self._clock, self._entered = clock, 0.0
        self._outer: Token[tuple[TimeLimit, ...]] | None = None

    @property
    def is_reached(self) -> bool:
        return self.used + self._clock() - self._entered > self.seconds

    def __enter__(self) -> "TimeLimit":
        self._outer, self._entered = _LIMITS.set((*_LIMITS.get(), self)), self._clock()
        return self

    def __exit__(self, *_: object) -> None:
        self.used += self._clock() - self._entered
        if self._outer is not None:
            _LIMITS.reset(self._outer)


_LIMITS: ContextVar[tuple[TimeLimit, ...]] = ContextVar("limits", default=())


def check_time() -> None:
    """Raise `TimeIsUp` if a limit is reached in whose block this is called; those that run for long call it often."""
    for limit in _LIMITS.get():
        if limit.is_reached:
            raise TimeIsUp(limit)


@contextmanager
def termination_raises(error: BaseException) -> Iterator[None]:
    """Let SIGTERM and SIGHUP, which by default end the process, raise an exception in a block, so that it can tidy up.

    Someone else's handlers are left alone, and so are threads other than the main one: they get no signals.
    """
    here = threading.current_thread() is threading.main_thread()
    ours = [number for number in _SIGNALS if here and signal.getsignal(number) is signal.SIG_DFL]

    def leave(_number: int, _frame: FrameType | None) -> NoReturn:
        raise error

    for number in ours:
        signal.signal(number, leave)
    try:
        yield
    finally:
        for number in ours:
            signal.signal(number, signal.SIG_DFL)


@contextmanager
def signals_wait() -> Iterator[None]:
    """Let signals wait until the end of a block in which others lose what handlers raise."""
    here = threading.current_thread() is threading.main_thread()
    numbers = [number for number in (signal.SIGINT, *_SIGNALS) if here and callable(signal.getsignal(number))]
    waiting: list[int] = []
    handlers = {number: signal.signal(number, lambda number, _: waiting.append(number)) for number in numbers}
    try:
        yield
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)
        for number in waiting:
            signal.raise_signal(number)
