"""Leave a piece of work in good order when the process is asked to end."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType


@contextmanager
def tidy_termination() -> Iterator[None]:
    """Let SIGTERM raise SystemExit in a block, so that temporary files are removed; by default it ends the process.

    Someone else's handler is left alone, and so are threads other than the main one: they get no signals.
    """
    here = threading.current_thread() is threading.main_thread()
    if not here or signal.getsignal(signal.SIGTERM) is not signal.SIG_DFL:
        yield
        return
    signal.signal(signal.SIGTERM, _leave)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)


def _leave(number: int, _frame: FrameType | None) -> None:
    raise SystemExit(128 + number)  # the status that a shell gives to a process ended by this signal
