"""Parse the command line, run the subcommand, and turn errors into one line and an exit status."""

import argparse
import logging
import os
import sys
from collections.abc import Sequence
from typing import NoReturn

from ..core.errors import MobiusFlowError
from ..core.termination import termination_raises
from . import bench, compare, energy, knot, methods, relax, verify

COMMANDS = (relax, energy, verify, compare, knot, bench, methods)
BAD_INPUT, FAILED, INTERRUPTED = 2, 1, 130


class _Parser(argparse.ArgumentParser):
    """A parser whose errors are one line."""

    def error(self, message: str) -> NoReturn:
        print(one_line(f"{self.prog}: {message} (see {self.prog} --help)"), file=sys.stderr)
        raise SystemExit(BAD_INPUT)


def one_line(text: str) -> str:
    """A sentence in which names with line ends, or what no terminal can show, are written with backslashes."""
    return "".join(c if c.isprintable() else repr(c)[1:-1] for c in text)


def parser() -> argparse.ArgumentParser:
    """The parser of the whole command line."""
    top = _Parser(prog="mobius-flow", description="Relax and untangle knotted curves by their Möbius energy.")
    subparsers = top.add_subparsers(dest="command", required=True, metavar="COMMAND", parser_class=_Parser)
    for command in COMMANDS:
        command.add_to(subparsers)
    return top


def main(arguments: Sequence[str] | None = None) -> int:
    """Run ``mobius-flow`` with the arguments (by default the process's) and return the exit status."""
    logging.basicConfig(format="mobius-flow: %(message)s", level=logging.WARNING, stream=sys.stderr)
    try:
        options = parser().parse_args(arguments)
        with termination_raises(KeyboardInterrupt()):  # so that the best curve is kept, as with Ctrl-C
            return int(options.run(options))
    except SystemExit as ended:
        return int(ended.code or 0)
    except MobiusFlowError as error:
        print(one_line(f"mobius-flow: {error}"), file=sys.stderr)
        return BAD_INPUT
    except KeyboardInterrupt:
        print("mobius-flow: interrupted", file=sys.stderr)
        return INTERRUPTED
    except BrokenPipeError:
        # the reader of our output has left; point stdout elsewhere so that Python's exit is quiet too
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return FAILED
