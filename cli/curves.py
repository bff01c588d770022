"""Curves from and to files and, as ``-``, the standard streams."""

import argparse
import os
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from ..core import Curve, CurveError, CurveFileError, write_curve
from ..core.base import wrong_suffix
from ..core.io import FORMATS, CurveFile, Format, load_curve
from .terminal import emit

STREAM, DEVICE = "-", "/dev/stdout"
INPUT, OUTPUT = "standard input", "standard output"
MAX_VERTICES = 200_000  # of curves that any command takes


def add_input(parser: argparse.ArgumentParser, what: str, name: str = "input", nargs: str | None = None) -> None:
    """Add the argument for curves that are read, and their format."""
    text = f"{what}: {', '.join(FORMATS)}, or - for standard input"
    parser.add_argument(name, metavar="IN", nargs=nargs, help=text)
    add_format(parser)


def add_format(parser: argparse.ArgumentParser, suffixes: Iterable[str] = FORMATS) -> None:
    """Add the option that decides where suffixes do not."""
    names = [suffix[1:] for suffix in suffixes]
    text = f"format of - and of files without a known suffix: {', '.join(names)} (default for -: txt)"
    parser.add_argument("--format", metavar="F", choices=names, help=text)


def format_for(path: str, name: str | None) -> Format:
    """The format by a file's suffix or else ``--format``; raises CurveFileError if neither says."""
    suffix = Path(path).suffix.lower()
    if suffix not in FORMATS and name is None and path != STREAM:
        raise CurveFileError(path, wrong_suffix(path, FORMATS, "curve files") + or_format(path))
    return FORMATS.get(suffix) or FORMATS[f".{name or 'txt'}"]


def or_format(path: str) -> str:
    """The advice on a file with an unknown suffix."""
    return "" if os.path.isdir(path) else ", others need --format"


def read(path: str, name: str | None = None) -> CurveFile:
    """Read a curve; raises CurveFileError."""
    form = format_for(path, name)
    if path != STREAM:
        return load_curve(path, form)
    if sys.stdin is None:
        raise CurveFileError(INPUT, "is closed")
    return load_curve(INPUT, form, sys.stdin.buffer)


@contextmanager
def measured(path: str, name: str | None) -> Iterator[Curve]:
    """A curve that is not too large to be examined; errors about it name its file and line."""
    file = read(path, name)
    with refusals(file):
        if len(file.curve) > MAX_VERTICES:
            raise CurveError(f"the curve has {len(file.curve)} vertices; at most {MAX_VERTICES} are allowed here")
        yield file.curve


def write(path: str, curve: Curve, name: str | None = None) -> None:
    """Write a curve; raises MobiusFlowError, or on standard output OutputStreamError or BrokenPipeError."""
    form = format_for(path, name)
    if path == STREAM:
        emit(form.text(curve).rstrip("\n"))
    else:
        write_curve(path, curve, form)


def check_regular(path: str | os.PathLike[str]) -> None:
    """Raise a CurveFileError unless there is a regular file: a pipe might never end."""
    if not os.path.isfile(path):
        raise CurveFileError(os.fspath(path), "cannot be read: it is missing, or not a regular file")


@contextmanager
def refusals(file: CurveFile) -> Iterator[None]:
    """Add the file's name and the line to errors about its curve."""
    try:
        yield
    except CurveFileError:
        raise
    except CurveError as error:
        raise file.refusal(error) from error
