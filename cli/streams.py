"""Standard streams that are closed, full, gone, or in an encoding that lacks our letters."""

import contextlib
import io
import logging
import os
import sys
from typing import Any, Self

from .terminal import sentence


class OutputStreamError(Exception):
    """Standard output cannot be written."""


def mend() -> None:
    """Make the process's streams safe to write to: whatever a terminal lacks is shown with backslashes.

    A closed standard output refuses what is written, a closed or full standard error swallows it.
    """
    with contextlib.suppress(OSError):
        while os.open(os.devnull, os.O_RDWR) < 2:  # so that no file of ours becomes a standard stream
            pass
    if sys.stdout is None:
        sys.stdout = open(os.devnull, encoding="utf-8")  # noqa: SIM115 - for reading only
    elif isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")
    encoding = "utf-8" if sys.stderr is None else sys.stderr.encoding
    file = io.BufferedWriter(_ForgivingFile(2, "w", closefd=False))  # type: ignore[type-var]
    sys.stderr = io.TextIOWrapper(file, encoding=encoding, errors="backslashreplace", line_buffering=True)


def emit(text: str) -> None:
    """Print to standard output, at once; raises OutputStreamError, or BrokenPipeError if the pipe is closed."""
    try:
        print(text, flush=True)
    except OSError as error:
        with contextlib.suppress(OSError, ValueError):  # the rest goes nowhere, so that Python's exit is quiet
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if isinstance(error, BrokenPipeError):
            raise
        reason = "it is closed" if isinstance(error, io.UnsupportedOperation) else error.strerror or error
        raise OutputStreamError(f"standard output cannot be written: {reason}") from error


class _ForgivingFile(io.FileIO):
    def write(self, data: bytes) -> int:  # type: ignore[override]
        try:
            return super().write(data)
        except OSError:  # a full device, a terminal that has gone
            return len(data)


class Notes(logging.Handler):
    """Collects the library's warnings while active: a refusal is one line, without earlier notes."""

    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self._lines: list[str] = []
        self._shown = False

    def __enter__(self) -> Self:
        logging.getLogger().addHandler(self)
        return self

    def __exit__(self, *_error: Any) -> None:
        logging.getLogger().removeHandler(self)

    def emit(self, record: logging.LogRecord) -> None:
        """Keep a line, or print it."""
        self._lines.append(f"mobius-flow: {record.getMessage()}")
        if self._shown:
            self.show()

    def show(self) -> None:
        """Print what has been collected; from now on, print what is logged at once."""
        self._shown = True
        for line in self._lines:
            print(sentence(line, sys.stderr), file=sys.stderr)
        self._lines.clear()
