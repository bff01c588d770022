"""Run the subcommand, and turn whatever ends it into one line and an exit status.

This module imports nothing that takes time: what a subcommand needs is imported under the same handler.
"""

import contextlib
import io
import logging
import os
import sys
import warnings
from collections.abc import Sequence

from . import signals, terminal

FAILED, BAD_INPUT = 1, 2


def process() -> int:
    """Run the command line as a process of its own, with its streams, signals and warnings.

    Streams are made safe to write to: whatever a terminal lacks is shown with backslashes, a closed standard output
    refuses what is written, and a closed or full standard error swallows it.
    """
    signals.leave_at_once()
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
    if not sys.warnoptions:
        warnings.simplefilter("ignore")  # they are for programmers; what users should know is logged
    try:
        return main()
    finally:
        signals.hold()  # all is written: a signal now changes nothing


class _ForgivingFile(io.FileIO):
    def write(self, data: bytes) -> int:  # type: ignore[override]
        try:
            return super().write(data)
        except OSError:  # a full device, a terminal that has gone
            return len(data)


class Notes(logging.Handler):
    """Collects the library's warnings until they are shown: a refusal is one line, without earlier notes."""

    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self._lines: list[str] = []
        self._shown = False

    def emit(self, record: logging.LogRecord) -> None:
        """Keep a line, or print it."""
        self._lines.append(f"mobius-flow: {record.getMessage()}")
        if self._shown:
            self.show()

    def show(self) -> None:
        """Print what has been collected; from now on, print what is logged at once."""
        self._shown = True
        for line in self._lines:
            print(terminal.sentence(line, sys.stderr), file=sys.stderr)
        self._lines.clear()


def main(arguments: Sequence[str] | None = None) -> int:
    """Run ``mobius-flow`` with the arguments (by default the process's) and return the exit status."""
    notes = Notes()
    logging.getLogger().addHandler(notes)
    try:
        from .parser import parse

        try:
            options = parse(arguments)
        except SystemExit:
            notes.show()  # of packages that cannot join
            raise
        with signals.raised():
            options.notes = notes
            status = int(options.run(options))
            if not getattr(options, "quiet", False):
                notes.show()
            return status
    except SystemExit as ended:
        return int(ended.code or 0)
    except KeyboardInterrupt as interrupt:
        sentence, status = str(interrupt) or "interrupted", signals.INTERRUPTED
    except BrokenPipeError:  # the downstream pipe was closed, which needs no sentence
        return FAILED
    except Exception as error:
        sentence, status = explained(error)
    finally:
        logging.getLogger().removeHandler(notes)
    if sys.stderr is not None:
        print(terminal.sentence(f"mobius-flow: {sentence}", sys.stderr), file=sys.stderr)
    return status


def explained(error: Exception) -> tuple[str, int]:
    """The sentence about an error, and the exit status."""
    if isinstance(error, MemoryError):
        return "there is not enough memory for this; use fewer vertices", FAILED
    if isinstance(error, ImportError | SyntaxError):
        return f"a required Python module cannot be loaded: {error}", FAILED
    if isinstance(error, OSError):
        name = "" if error.filename is None else f"{error.filename}: "
        return f"{name}{error.strerror or error}", BAD_INPUT
    from ..core.base.errors import MobiusFlowError

    if isinstance(error, MobiusFlowError):
        return str(error), BAD_INPUT
    trace = error.__traceback__
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    place = "" if trace is None else f" ({trace.tb_frame.f_code.co_filename}, line {trace.tb_lineno})"
    return f"internal error, please report it: {type(error).__name__}: {error}{place}", FAILED
