"""Standard streams that are closed, full, gone, or of an encoding that lacks our letters."""

import contextlib
import io
import os
import sys
from typing import TextIO


class OutputStreamError(Exception):
    """Standard output does not take what is written."""


def mend() -> None:
    """Make the process's streams fit to be written to: whatever a terminal lacks is shown with backslashes.

    A closed standard output refuses what is written, a closed or full standard error swallows it.
    """
    with contextlib.suppress(OSError):
        while os.open(os.devnull, os.O_RDWR) < 2:  # so that no file of ours becomes a standard stream
            pass
    if sys.stdout is None:
        sys.stdout = open(os.devnull, encoding="utf-8")  # noqa: SIM115 - for reading only
    elif isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")
    sys.stderr = _forgiving(sys.stderr)


def emit(text: str) -> None:
    """Print to standard output, at once; raises OutputStreamError, or BrokenPipeError if its reader has left."""
    try:
        print(text, flush=True)
    except BrokenPipeError:
        discard_output()
        raise
    except OSError as error:
        discard_output()
        reason = "it is closed" if isinstance(error, io.UnsupportedOperation) else error.strerror or error
        raise OutputStreamError(f"standard output cannot be written: {reason}") from error


def discard_output() -> None:
    """Send what is still to be written to standard output nowhere, so that Python's exit is quiet."""
    with contextlib.suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def one_line(text: str) -> str:
    """A sentence in which names with line ends, or what no terminal can show, are written with backslashes."""
    return "".join(c if c.isprintable() else repr(c)[1:-1] for c in text)


class _ForgivingFile(io.FileIO):
    def write(self, data: bytes) -> int:  # type: ignore[override]
        try:
            return super().write(data)
        except OSError:  # a full device, a terminal that has gone
            return len(data)


def _forgiving(stream: TextIO | None) -> TextIO:
    encoding = "utf-8" if stream is None else stream.encoding
    file = io.BufferedWriter(_ForgivingFile(2, "w", closefd=False))  # type: ignore[type-var]
    return io.TextIOWrapper(file, encoding=encoding, errors="backslashreplace", line_buffering=True)
