"""Run the subcommand, and turn whatever ends it into one line and an exit status.

This module imports nothing that takes time: what a subcommand needs is imported under the same handler.
"""

import sys
import warnings
from collections.abc import Sequence

from . import signals, streams, terminal

FAILED, BAD_INPUT = 1, 2


def process() -> int:
    """Run the command line as a process of its own, with its streams, signals and warnings."""
    signals.leave_at_once()
    streams.mend()
    if not sys.warnoptions:
        warnings.simplefilter("ignore")  # they are for programmers; what users should know is logged
    try:
        return main()
    finally:
        signals.hold()  # all is written: a signal now changes nothing


def main(arguments: Sequence[str] | None = None) -> int:
    """Run ``mobius-flow`` with the arguments (by default the process's) and return the exit status."""
    try:
        from .parser import parse

        with streams.Notes() as notes:
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
        return _end(str(interrupt) or "interrupted", signals.INTERRUPTED)
    except BrokenPipeError:  # the downstream pipe was closed, which needs no sentence
        return FAILED
    except MemoryError:
        return _end("there is not enough memory for this; use fewer vertices", FAILED)
    except Exception as error:
        return _end(*explained(error))


def _end(sentence: str, status: int) -> int:
    if sys.stderr is not None:
        print(terminal.sentence(f"mobius-flow: {sentence}", sys.stderr), file=sys.stderr)
    return status


def explained(error: Exception) -> tuple[str, int]:
    if isinstance(error, streams.OutputStreamError):
        return str(error), BAD_INPUT
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
