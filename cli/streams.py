"""Standard streams that are closed, full, gone, or of an encoding without our letters, and progress on them."""

import contextlib
import io
import logging
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Self

from ..addon.engine.words import time_left
from ..core import Iterate, RelaxOptions
from ..core.driver import TimeLeft


class OutputStreamError(Exception):
    """Standard output cannot be written."""


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
    encoding = "utf-8" if sys.stderr is None else sys.stderr.encoding
    file = io.BufferedWriter(_ForgivingFile(2, "w", closefd=False))  # type: ignore[type-var]
    sys.stderr = io.TextIOWrapper(file, encoding=encoding, errors="backslashreplace", line_buffering=True)


def emit(text: str) -> None:
    """Print to standard output, at once; raises OutputStreamError, or BrokenPipeError if the pipe is closed."""
    try:
        print(text, flush=True)
    except OSError as error:
        with contextlib.suppress(OSError, ValueError):  # what is left goes nowhere, so that Python's exit is quiet
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if isinstance(error, BrokenPipeError):
            raise
        reason = "it is closed" if isinstance(error, io.UnsupportedOperation) else error.strerror or error
        raise OutputStreamError(f"standard output cannot be written: {reason}") from error


def one_line(text: str) -> str:
    """A sentence in which line ends in names, and what no terminal can show, are written with backslashes."""
    return "".join(c if c.isprintable() else repr(c)[1:-1] for c in text)


class _ForgivingFile(io.FileIO):
    def write(self, data: bytes) -> int:  # type: ignore[override]
        try:
            return super().write(data)
        except OSError:  # a full device, a terminal that has gone
            return len(data)


class Notes(logging.Handler):
    """Collects the library's warnings while it is entered: a refusal is one line, without what was noted before it."""

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
        self._lines.append(one_line(f"mobius-flow: {record.getMessage()}"))
        if self._shown:
            self.show()

    def show(self) -> None:
        """Print what has been collected, and from now on what is logged at once."""
        self._shown = True
        for line in self._lines:
            print(line, file=sys.stderr)
        self._lines.clear()


@contextmanager
def bar(shown: bool, **options: Any) -> Iterator[Any]:
    """A bar of tqdm that vanishes in the end; None if it is not to be shown, or tqdm is not installed."""
    try:
        from tqdm.auto import tqdm
    except ImportError:
        shown = False
    if not shown:
        yield None
        return
    with tqdm(leave=False, **options) as made:
        yield made


class Progress:
    """Lets a bar run from the first gradient norm down to the tolerance, on a logarithmic scale."""

    def __init__(self, options: RelaxOptions) -> None:
        self._left = TimeLeft(options)
        self._start: float | None = None

    def update(self, bar: Any, iterate: Iterate) -> None:
        """Show an iterate, if there is a bar."""
        if bar is None:
            return
        self._left.add(iterate)
        distance, seconds = self._left.distances[-1], self._left.seconds
        if self._start is None:
            self._start = max(distance, 1e-9)
        bar.n = max(bar.n, round(100 * (1 - distance / self._start)))
        bar.set_postfix_str(
            f"iteration {iterate.index}, objective {iterate.energy:.6g}, gradient {iterate.gradient_norm:.2g}"
            f"{f', {time_left(seconds)}' if seconds else ''}"
        )


@contextmanager
def progress(options: RelaxOptions | None = None, shown: bool = True) -> Iterator[Callable[[Iterate], None]]:
    """Give what draws a bar when it is called with the iterates of a run, such as `minimize` does with a callback."""
    drawn = Progress(RelaxOptions() if options is None else options)
    with bar(shown, total=100, bar_format="{l_bar}{bar}| {elapsed} {postfix}") as made:
        yield lambda iterate: drawn.update(made, iterate)


@contextmanager
def leg_progress(shown: bool) -> Iterator[Callable[[int, int], None] | None]:
    """Give what shows the numbers of legs that are checked and of all, or None where nothing can be shown."""
    with bar(shown, unit=" legs") as legs:

        def show(done: int, total: int) -> None:
            legs.total = total or None
            legs.update(done - legs.n)

        yield None if legs is None else show


def show_frames(done: int, total: int) -> None:
    """Show on one line how far a film is."""
    print(f"\rrendering frame {done} of {total}", end="\n" if done == total else "", file=sys.stderr, flush=True)
