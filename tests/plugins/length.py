"""``mobius-flow length``: the length of a curve."""

import argparse

from . import curves
from .terminal import emit


def add_length(parser: argparse.ArgumentParser) -> None:
    """Describe the subcommand."""
    parser.description = "Print the length of a curve."
    parser.add_argument("input", metavar="IN")
    curves.add_format(parser)
    parser.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    emit(repr(curves.read(options.input, options.format).curve.length))
    return 0
