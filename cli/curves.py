"""Curves from and to files and, as ``-``, the standard streams."""

import argparse
import os
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from ..core import Curve, CurveError, CurveFileError, MobiusFlowError, write_curve
from ..core.curve.io import FORMATS, CurveFile, Format, load_curve
from ..core.errors import wrong_suffix
from .streams import OutputStreamError, emit

STREAM, DEVICE = "-", "/dev/stdout"
INPUT, OUTPUT = "standard input", "standard output"
MAX_VERTICES = 200_000  # of curves that any command takes


def add_format(parser: argparse.ArgumentParser, suffixes: Iterable[str] = FORMATS) -> None:
    """Add the option that tells what the suffix does not."""
    names = [suffix[1:] for suffix in suffixes]
    parser.add_argument(
        "--format",
        metavar="F",
        choices=names,
        help=f"what - and files without a known suffix hold: {', '.join(names)} (default for -: txt)",
    )


def format_for(path: str, name: str | None) -> Format:
    """The format that a file's suffix or else ``--format`` tells; raises CurveFileError if neither does."""
    suffix = Path(path).suffix.lower()
    if suffix not in FORMATS and name is None and path != STREAM:
        raise CurveFileError(path, wrong_suffix(path, FORMATS, "curve files") + unless_told(path))
    return FORMATS.get(suffix) or FORMATS[f".{name or 'txt'}"]


def unless_told(path: str) -> str:
    """What else to do about a file's unknown suffix."""
    return "" if os.path.isdir(path) else ", others need --format"


def read(path: str, name: str | None = None) -> CurveFile:
    """Read a curve; raises CurveFileError."""
    form = format_for(path, name)
    if path != STREAM:
        return load_curve(path, form)
    if sys.stdin is None:
        raise CurveFileError(INPUT, "is closed")
    return load_curve(INPUT, form, sys.stdin.buffer)


def write(path: str, curve: Curve, name: str | None = None) -> None:
    """Write a curve; raises MobiusFlowError, or BrokenPipeError where nobody reads standard output."""
    form = format_for(path, name)
    if path != STREAM:
        write_curve(path, curve, form)
        return
    try:
        emit(form.text(curve).rstrip("\n"))
    except OutputStreamError as error:
        raise MobiusFlowError(str(error)) from error


def check_regular(path: str | os.PathLike[str]) -> None:
    """Raise a CurveFileError unless there is a regular file: a pipe might never end."""
    if not os.path.isfile(path):
        raise CurveFileError(os.fspath(path), "cannot be read: it is missing, or no regular file")


@contextmanager
def refusals(file: CurveFile) -> Iterator[None]:
    """Add the file's name and the line to errors about its curve."""
    try:
        yield
    except CurveFileError:
        raise
    except CurveError as error:
        raise file.refusal(error) from error
