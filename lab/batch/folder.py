"""Folders of results, each whole or absent; what somebody else wrote is never moved, changed or removed."""

import hashlib
import json
import os
import re
import secrets
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from ...core import MobiusFlowError, Status
from ...core.base.errors import reason_of
from .job import CURVE, REPORT, TRAJECTORY, Job, foreign, limit_of, sha256_of
from .table import Row

_ROOM = ".mobius-flow-{}.partial"  # short, so that it fits beside any valid name of results
_NOTE = "note"  # in a room while it is filled
_OURS = re.compile("|".join([*map(re.escape, (CURVE, REPORT, TRAJECTORY, _NOTE)), r"\.[0-9a-f]{16}\.npz"]))
_FILES = "files"  # of a report: the mark, SHA-256 of each file as it was written


@contextmanager
def new_folder(path: Path) -> Iterator[Path]:
    """Give an empty directory to fill; it replaces ``path`` if the block ends well, and otherwise vanishes."""
    room = _beside(path)
    room.mkdir()
    try:
        (room / _NOTE).write_bytes(_note(room))
        yield room
        (room / _NOTE).unlink()
        while True:  # existing results are replaced in one move, so that nobody finds half of them
            check_replaceable(path)
            with suppress(FileNotFoundError):
                old = _beside(path)
                path.rename(old)
                _remove(old)
            try:
                room.rename(path)
            except OSError:
                if not path.exists():
                    raise
            else:
                return
    finally:
        with suppress(OSError):
            _remove(room)


def _note(room: Path) -> bytes:
    return f"mobius-flow batch is filling {room.name}\n".encode()


def _beside(path: Path) -> Path:
    """A new name for something that is not in its place yet, or no longer."""
    return path.with_name(_ROOM.format(secrets.token_hex(8)))


def _remove(folder: Path) -> None:
    """Remove a folder, except files whose names are not ours; OSError if there are any."""
    for path in folder.iterdir():
        if _OURS.fullmatch(path.name):
            path.unlink()
    folder.rmdir()


def check_replaceable(path: Path) -> None:
    """Raise a MobiusFlowError if there is anything other than results, whole and as a batch wrote them."""
    try:
        path.lstat()
    except FileNotFoundError:
        return
    except OSError as error:  # such as a name too long: each file system has its own limit
        raise MobiusFlowError(f"{path}: cannot be a folder of results: {reason_of(error)}; rename the input") from error
    report = _report(path)
    written = report.pop(_FILES, None)
    if path.is_symlink() or not isinstance(written, dict) or written.pop(REPORT, None) != _sha256_of(report):
        raise foreign(path, "batch")
    for each in sorted(path.iterdir()):
        if each.is_symlink() or (each.name != REPORT and written.get(each.name, "") != sha256_of(each)):
            raise foreign(each, "batch")


def _report(folder: Path) -> dict[str, Any]:
    """The contents of the report of results; empty if there is none."""
    try:
        if not (folder / REPORT).is_file():  # a pipe might never end
            return {}
        report = json.loads((folder / REPORT).read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return {}
    return report if isinstance(report, dict) else {}


def _sha256_of(report: dict[str, Any]) -> str:
    return hashlib.sha256(json.dumps(report).encode()).hexdigest()


def sweep(directory: Path) -> None:
    """Remove the rooms that killed runs have left behind, but none that runs of another batch may still be filling."""
    for room in directory.glob(_ROOM.format("*")):
        with suppress(OSError):
            note = room / _NOTE
            # 3600.0: seconds after which a room counts as abandoned: filling one takes seconds
            old = time.time() - room.stat().st_mtime > 3600.0
            if old and note.is_file() and note.read_bytes() == _note(room):
                _remove(room)


def finished(job: Job) -> Row | None:
    """The row of a run that already has results; None if they are missing, or made by another recipe.

    A run that was stopped by its time limit is not finished if there is more time now.
    """
    report = _report(Path(job.folder))
    try:
        row = Row(**report["row"]) if report["recipe"] == job.recipe else None
        stopped = row is not None and row.status == Status.TIME_LIMIT.value
        return None if stopped and job.time_limit > limit_of(report["options"]) else row
    except (KeyError, TypeError, ValueError):
        return None


def results(directory: Path) -> Iterator[tuple[Path, dict[str, Any], Row]]:
    """The result folders in a directory whose reports are as a batch wrote them, with their reports and rows.

    Raises a MobiusFlowError if there are none.
    """
    found = 0
    for folder in sorted(directory.iterdir()) if directory.is_dir() else ():
        report = _report(folder)
        files = report.pop(_FILES, None)
        if isinstance(files, dict) and files.get(REPORT) == _sha256_of(report):
            with suppress(KeyError, TypeError):  # rows of other versions
                yield folder, report | {_FILES: files}, Row(**report["row"])
                found += 1
    if not found:
        raise MobiusFlowError(f"{directory}: holds no results of mobius-flow batch")


def write_report(room: Path, job: Job, row: Row, report: dict[str, object]) -> None:
    """Write the report, last of all, with what `finished` looks for and the mark by which the files are ours."""
    report = report | {"row": vars(row), "recipe": job.recipe}
    marks = {name: sha256_of(room / name) for name in (CURVE, TRAJECTORY)}
    write_text(room / REPORT, json.dumps(report | {_FILES: marks | {REPORT: _sha256_of(report)}}, indent=1) + "\n")


def write_text(path: Path, text: str) -> None:
    """Write a new file, down to the disk."""
    with path.open("w", encoding="utf-8") as stream:
        stream.write(text)
        stream.flush()
        os.fsync(stream.fileno())
