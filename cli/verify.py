"""``mobius-flow verify``: check a trajectory independently of the run that wrote it."""

import argparse
import json
import os
import sys
import tempfile
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import asdict
from typing import BinaryIO

from ..core import MobiusFlowError
from ..core.errors import reason_of
from ..core.verify import verify
from .curves import INPUT, STREAM
from .places import is_file
from .progress import leg_progress
from .streams import emit

MAX_BYTES = 4 << 30  # of a stream, which is copied to a temporary file: archives are read from their ends
_PIECE = 1 << 20
_EPILOG = """\
examples:
  mobius-flow verify path.npz
  mobius-flow relax knot.txt out.txt --quiet --trajectory - | mobius-flow verify - --json

In JSON stages and frames are counted from 0, edges and the obstacle, as in "reason", from 1.

exit status:
  0    accepted: free of contact, with proof
  1    rejected, also as damaged or no trajectory; the line, or "reason" of the JSON, says why and where
  2    bad options, or a file that is missing or cannot be opened
  130  interrupted
"""


def add_verify(parser: argparse.ArgumentParser) -> None:
    parser.description, parser.epilog = "Check a trajectory for contact, independently of the run.", _EPILOG
    parser.add_argument("trajectory", metavar="T.npz", help="as written by relax --trajectory, or - for standard input")
    parser.add_argument("--json", action="store_true", help="print the verdict as JSON")
    parser.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    with _seekable(options.trajectory) as path, leg_progress(sys.stderr.isatty()) as progress:
        verdict = verify(path, progress)
    edges = verdict.edges and [edge + 1 for edge in verdict.edges]  # from 1, as in the reason
    obstacle = None if verdict.obstacle is None else verdict.obstacle + 1
    plain = asdict(verdict) | {"edges": edges, "obstacle": obstacle}
    emit(json.dumps(plain) if options.json else str(verdict))
    return 0 if verdict.accepted else 1


@contextmanager
def _seekable(path: str) -> Iterator[str]:
    """A file with the same contents that can be read from its end: itself, or a copy of a stream."""
    with _opened(path) as stream:
        if is_file(path):
            yield path
            return
        with tempfile.TemporaryDirectory(prefix="mobius-flow-") as room:
            copy = os.path.join(room, "trajectory.npz")
            _spool(INPUT if path == STREAM else path, stream, copy)
            yield copy


def _opened(path: str) -> AbstractContextManager[BinaryIO]:
    """The file, open, or standard input; a MobiusFlowError says why there is none."""
    if path == STREAM:
        if sys.stdin is None:
            raise MobiusFlowError(f"{INPUT} is closed")
        return nullcontext(sys.stdin.buffer)
    try:
        return open(path, "rb")
    except (OSError, ValueError) as error:  # a ValueError for a null character
        raise MobiusFlowError(f"{path}: cannot be read: {reason_of(error)}") from error


def _spool(name: str, stream: BinaryIO, target: str) -> None:
    with open(target, "wb") as copy:
        while piece := stream.read(_PIECE):
            if copy.tell() == 0 and not piece.startswith(b"PK"):
                raise MobiusFlowError(f"{name}: not a trajectory: an .npz file starts with the letters PK")
            if copy.tell() > MAX_BYTES:
                raise MobiusFlowError(f"{name}: longer than {MAX_BYTES >> 30} GB; verify a file")
            copy.write(piece)
