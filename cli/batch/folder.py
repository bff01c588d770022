"""Folders of results, each whole or not there."""

import json
import os
import secrets
import shutil
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from ...core import MobiusFlowError
from ...core.errors import reason_of
from .job import REPORT, Job
from .table import Row

_ROOM = ".mobius-flow-{}.partial"  # short, so that whatever can be the name of results has one beside it
_ABANDONED = 3600.0  # seconds after which nobody fills a folder any more: it takes seconds


@contextmanager
def new_folder(path: Path) -> Iterator[Path]:
    """Give an empty directory to fill; it takes the place of ``path`` when the block ends well, and else vanishes."""
    room = _beside(path)
    room.mkdir()
    try:
        yield room
        _take_place(room, path)
    finally:
        shutil.rmtree(room, ignore_errors=True)


def _beside(path: Path) -> Path:
    """A new name for what is not, or no longer, in its place."""
    return path.with_name(_ROOM.format(secrets.token_hex(8)))


def _take_place(room: Path, path: Path) -> None:
    """Move a directory; results that are there give way, and only empty directories do so in a single move."""
    check_replaceable(path)
    try:
        room.rename(path)
    except OSError:
        old = _beside(path)
        path.rename(old)
        room.rename(path)
        shutil.rmtree(old, ignore_errors=True)


def check_replaceable(path: Path) -> None:
    """Raise a MobiusFlowError if there is something else than results."""
    if os.path.lexists(path) and not (path / REPORT).is_file():
        raise MobiusFlowError(f"{path}: is there already, and holds no results; move it, or name another directory")


def check_name(path: Path) -> None:
    """Raise a MobiusFlowError if no folder can be called so, as names too long cannot: before work is put into it."""
    try:
        path.lstat()  # each file system has its own limit
    except FileNotFoundError:
        return
    except OSError as error:
        raise MobiusFlowError(
            f"{path.name} cannot be the name of a folder: {reason_of(error)}; give a file with another name"
        ) from error


def sweep(directory: Path) -> None:
    """Remove what killed runs have left behind, and nothing that runs of another batch may still be filling."""
    for room in directory.glob(_ROOM.format("*")):
        with suppress(FileNotFoundError):
            if time.time() - room.stat().st_mtime > _ABANDONED:
                shutil.rmtree(room, ignore_errors=True)


def finished(job: Job) -> Row | None:
    """The row of a run whose results are there already; None if they are missing, or of another recipe."""
    try:
        report: Any = json.loads(Path(job.folder, REPORT).read_text(encoding="utf-8"))
        return Row(**report["row"]) if report["recipe"] == job.recipe else None
    except (OSError, ValueError, KeyError, TypeError):
        return None


def write_report(room: Path, job: Job, row: Row, report: dict[str, object]) -> None:
    """Write the report, with what `finished` looks for."""
    text = json.dumps(report | {"row": vars(row), "recipe": job.recipe}, indent=1) + "\n"
    with (room / REPORT).open("w", encoding="utf-8") as stream:
        stream.write(text)
        stream.flush()
        os.fsync(stream.fileno())
