"""The runs of a batch: the meaning of the words of its command line, and where the results of each run go."""

import glob
import hashlib
import json
import math
import os
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, NamedTuple

from ... import __version__
from ...core import MobiusFlowError, RelaxOptions
from ...core.io import FORMATS
from ...core.io.source import Source
from ...core.knots import knot
from ...core.knots.diagrams.codes import is_code
from ...core.knots.names import table_range

CURVE, REPORT, TRAJECTORY = "curve.txt", "report.json", "trajectory.npz"
STILL = ("avoid", "pins", "pin_tangents")  # options of a task, beside those of its relaxation
CSV, PARQUET = "results.csv", "results.parquet"
TIGHT = "tight"  # the kind of runs that pull a knot tight
_FORMULA = tuple("=+-@\t\r\n＝＋－＠")  # characters that begin a formula in a spreadsheet


class Input(NamedTuple):
    """A curve to start from: the name of its results, and its file; None for a knot that is made by its name."""

    name: str
    file: Path | None = None


def inputs(words: Iterable[str]) -> list[Input]:
    """The inputs that words stand for, in order and without repeats; a MobiusFlowError names meaningless words."""
    found: list[Input] = []
    for word in words:
        paths = [word] if os.path.lexists(word) else []  # first, so that a file may be called like a knot
        if paths or (glob.has_magic(word) and (paths := sorted(glob.glob(word, recursive=True)))):
            for path in map(Path, paths):
                files = [path]
                if path.is_dir():
                    files = sorted(each for each in path.iterdir() if each.suffix.lower() in FORMATS)
                if not files:
                    raise MobiusFlowError(f"{path}: holds no curve files; they end in {', '.join(FORMATS)}")
                for file in files:  # after which results are named
                    name = file.stem if file.stem.strip(".") else file.name  # nothing but dots is another directory
                    shown = os.fsencode(name).decode(errors="backslashreplace")  # tables have text only
                    found.append(Input(as_text(shown), Path(os.path.abspath(file))))
        elif is_code(word):
            raise MobiusFlowError(f"{word[:60]}: a code cannot name a folder; put it in a .pd, .dt or .gauss file")
        elif glob.has_magic(word):
            raise MobiusFlowError(f"{word}: matches no file")
        elif os.path.dirname(word) or Path(word).suffix.lower() in FORMATS:
            raise MobiusFlowError(f"{word}: there is no such file")
        elif ".." in word:
            found += map(Input, table_range(word))
        else:
            knot(word)  # which reports names that mean nothing
            found.append(Input(word.strip()))
    if not found:
        raise MobiusFlowError("there is nothing to relax: name a file, a directory or a knot")
    return list(dict.fromkeys(found))


def as_text(text: str) -> str:
    """A text that no spreadsheet takes for a formula and runs."""
    return f"_{text}" if text.startswith(_FORMULA) else text


@dataclass(frozen=True)
class Job:
    """One run, in plain values, which travel to other machines; its folder identifies it."""

    name: str  # of the input
    start: int  # 1 for the input itself
    seed: int | None  # of random starts
    file: str | None  # absolute path of the input; None for a knot that is made by its name
    sha256: str | None  # of the file when the job was made; None where there is nothing to read
    folder: str  # absolute path of the results
    options: Mapping[str, object]  # of the relaxation: obstacles as absolute paths with their hashes
    extrapolate: bool  # whether the smooth curve's energy is wanted
    tight: int = 0  # starts of a knot that is pulled tight instead; 0 for relaxations
    version: str = __version__  # of the program that made the job

    def __hash__(self) -> int:  # options are in a dictionary, which has none
        return hash(self.folder)

    @property
    def time_limit(self) -> float:
        """Seconds that the relaxation may take; infinite without a limit."""
        return limit_of(self.options)

    @property
    def recipe(self) -> dict[str, object]:
        """All that the results depend on, as JSON: runs with equal recipes need not be repeated."""
        made = asdict(self)
        del made["folder"], made["file"]
        made["options"].pop("time_limit", None)
        if not self.options.get("hops"):
            made["options"].pop("seed", None)  # which only hops use: a scrambled start's seed is the job's own
        plain: dict[str, object] = json.loads(json.dumps(made))
        return plain


def limit_of(options: Mapping[str, object]) -> float:
    """The time limit among options, in seconds; infinite without one."""
    limit = options.get("time_limit")
    return math.inf if limit is None else float(str(limit))


def folder_name(name: str, start: int) -> str:
    """The name of the folder of a run's results."""
    return name if start == 1 else f"{name}-{start}"


@dataclass(frozen=True)
class Plan:
    """The runs of a batch, first starts first; each is made when its turn comes, as there may be very many."""

    inputs: Mapping[str, tuple[str | None, str | None]]  # the file of each and its hash, by its name
    starts: int
    directory: Path
    options: Mapping[str, Any]
    extrapolate: bool
    tight: int

    def __len__(self) -> int:
        return self.starts * len(self.inputs)

    def __iter__(self) -> Iterator[Job]:
        return (self._job(name, start) for start in range(1, self.starts + 1) for name in self.inputs)

    def standing(self) -> Iterator[Job]:
        """The runs whose folders are there."""
        for path in self.directory.iterdir() if self.directory.is_dir() else ():
            if (found := _started(path.name, self.inputs, self.starts)) is not None:
                yield self._job(*found)

    def _job(self, name: str, start: int) -> Job:
        seed = None if start == 1 else self.options["seed"] + start
        folder = str(self.directory / folder_name(name, start))
        return Job(name, start, seed, *self.inputs[name], folder, self.options, self.extrapolate, self.tight)


def _started(folder: str, names: Collection[str], starts: int) -> tuple[str, int] | None:
    """The input's name and the number of the start whose folder is called so; None if there is none."""
    name, _, number = folder.rpartition("-")
    if name in names and number.isdecimal() and len(number) < 19:
        start = int(number)
        if 2 <= start <= starts and folder == folder_name(name, start):
            return name, start
    return (folder, 1) if folder in names else None


def jobs(
    inputs: Iterable[Input],
    starts: int,
    directory: Path,
    options: RelaxOptions,
    still: Mapping[str, Any],
    extrapolate: bool,
    tighten: bool = False,
) -> Plan:
    """The runs of a batch; a MobiusFlowError if two would share a folder.

    ``still`` are the obstacles' files, pins and pin_tangents of all of them.  Tightening has one run with all starts.
    """
    starts, tight = (1, starts) if tighten else (starts, 0)
    obstacles = {str(Path(path).resolve()): _hash(Path(path)) for path in still["avoid"]}
    files = list(inputs)
    count = Counter(name.casefold() for name, _ in files)  # some file systems ignore case
    for name, file in files:
        _, start = _started(name.casefold(), count, starts) or ("", 0)
        if count[name.casefold()] > 1 or start > 1 or name.casefold() in (CSV, PARQUET):  # where the tables are
            raise MobiusFlowError(f"{file or name}: another input has its results in {name}; rename it")
    named = {name: (None, None) if file is None else (str(file), _hash(file)) for name, file in files}
    return Plan(named, starts, directory, {**vars(options.resolved), **still, "avoid": obstacles}, extrapolate, tight)


def _hash(path: Path) -> str | None:
    """The hash of a file's bytes; None for files that no run can read: the run reports why."""
    try:
        return sha256_of(path) if path.stat().st_size <= Source.max_bytes else None
    except OSError:
        return None


def sha256_of(path: Path) -> str | None:
    """The hash of a regular file; None for anything else, such as a pipe, which might never end."""
    if not path.is_file():
        return None
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def foreign(path: Path, command: str) -> MobiusFlowError:
    """The error about something in the way of a command's files: a command replaces nothing but its own."""
    why = f"was not written by mobius-flow {command}, or has been changed since"
    return MobiusFlowError(f"{path}: {why}; move it, or name another directory")
