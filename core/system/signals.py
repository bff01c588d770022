"""Leave a piece of work in good order when the process is asked to end."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import NoReturn

_NUMBERS = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]


@contextmanager
def termination_raises(error: BaseException) -> Iterator[None]:
    """Let SIGTERM and SIGHUP, which by default end the process, raise an exception in a block, so that it can tidy up.

    Someone else's handlers are left alone, and so are threads other than the main one: they get no signals.
    """
    here = threading.current_thread() is threading.main_thread()
    ours = [number for number in _NUMBERS if here and signal.getsignal(number) is signal.SIG_DFL]

    def leave(_number: int, _frame: FrameType | None) -> NoReturn:
        raise error

    for number in ours:
        signal.signal(number, leave)
    try:
        yield
    finally:
        for number in ours:
            signal.signal(number, signal.SIG_DFL)
