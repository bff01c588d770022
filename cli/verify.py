"""``mobius-flow verify``: check a trajectory independently of the run that wrote it."""

import argparse
import json
import os
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import asdict

from ..core.base import MobiusFlowError, reason_of
from ..core.proof import verify
from .curves import INPUT, STREAM
from .places import is_file
from .progress import live
from .terminal import GREEN, RED, emit, painted, wrapped

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
    with _seekable(options.trajectory) as path, live() as show:
        verdict = verify(path, lambda done, total: show(f"{done:,} of {total:,} legs checked"))
    edges = verdict.edges and [edge + 1 for edge in verdict.edges]  # from 1, as in the reason
    obstacle = None if verdict.obstacle is None else verdict.obstacle + 1
    plain = asdict(verdict) | {"edges": edges, "obstacle": obstacle}
    word, _, rest = wrapped(str(verdict), sys.stdout).partition(":")
    told = painted(word, GREEN if verdict.accepted else RED, sys.stdout)
    emit(json.dumps(plain) if options.json else f"{told}:{rest}")
    return 0 if verdict.accepted else 1


@contextmanager
def _seekable(path: str) -> Iterator[str]:
    """A file with the same contents that can be read from its end: itself, or a copy of a stream."""
    if path == STREAM and sys.stdin is None:
        raise MobiusFlowError(f"{INPUT} is closed")
    try:
        opened = nullcontext(sys.stdin.buffer) if path == STREAM else open(path, "rb")  # noqa: SIM115
    except (OSError, ValueError) as error:  # a ValueError for a null character
        raise MobiusFlowError(f"{path}: cannot be read: {reason_of(error)}") from error
    with opened as stream:
        if is_file(path):
            yield path
            return
        with tempfile.TemporaryDirectory(prefix="mobius-flow-") as room:
            copy = os.path.join(room, "trajectory.npz")
            name, most = INPUT if path == STREAM else path, 4 << 30  # bytes
            with open(copy, "wb") as target:
                while piece := stream.read(1 << 20):
                    if target.tell() == 0 and not piece.startswith(b"PK"):
                        raise MobiusFlowError(f"{name}: not a trajectory: an .npz file starts with the letters PK")
                    if target.tell() > most:
                        raise MobiusFlowError(f"{name}: longer than {most >> 30} GB; verify a file")
                    target.write(piece)
            yield copy
