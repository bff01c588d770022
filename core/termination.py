"""Leave a piece of work in good order when the process is asked to end."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import NoReturn


@contextmanager
def termination_raises(error: BaseException) -> Iterator[None]:
    """Let SIGTERM, which by default ends the process, raise an exception in a block, so that things can be tidied up.

    Someone else's handler is left alone, and so are threads other than the main one: they get no signals.
    """
    here = threading.current_thread() is threading.main_thread()
    if not here or signal.getsignal(signal.SIGTERM) is not signal.SIG_DFL:
        yield
        return

    def leave(_number: int, _frame: FrameType | None) -> NoReturn:
        raise error

    signal.signal(signal.SIGTERM, leave)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
