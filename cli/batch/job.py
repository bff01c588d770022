"""One run of a batch: what it starts from, and where its results go."""

import hashlib
import json
import math
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from ... import __version__
from ...core import MobiusFlowError, RelaxOptions
from ...core.curve.io.source import MAX_BYTES
from .inputs import Input

CURVE, REPORT, TRAJECTORY = "curve.txt", "report.json", "trajectory.npz"
STILL = ("avoid", "pins", "pin_tangents")  # options of a task, beside those of its relaxation
CSV, PARQUET = "results.csv", "results.parquet"


@dataclass(frozen=True)
class Job:
    """One run, in plain values, which travel to other machines; its folder tells it from others."""

    name: str  # of the input
    start: int  # 1 for the input itself; above that it is scrambled
    seed: int | None  # that it is scrambled by
    file: str | None  # absolute path of the input; None for a knot that is made by its name
    sha256: str | None  # of the file when the job was made; None where there is nothing to read
    folder: str  # absolute path of the results
    options: Mapping[str, object]  # of the relaxation: obstacles as absolute paths with their hashes
    extrapolate: bool  # whether the smooth curve's energy is wanted
    version: str = __version__  # of the program that made the job

    def __hash__(self) -> int:  # options are in a dictionary, which has none
        return hash(self.folder)

    @property
    def time_limit(self) -> float:
        """Seconds that the relaxation may take; infinite without a limit."""
        return limit_of(self.options)

    @property
    def recipe(self) -> dict[str, object]:
        """All that the results depend on, as JSON has it: runs of equal recipes need not be repeated."""
        made = asdict(self)
        del made["folder"], made["file"]
        made["options"].pop("time_limit", None)
        if not self.options.get("hops"):
            made["options"].pop("seed", None)  # which only hops draw from: that of a scrambled start is the job's own
        plain: dict[str, object] = json.loads(json.dumps(made))
        return plain


def limit_of(options: Mapping[str, object]) -> float:
    """The time limit among options, in seconds; infinite without one."""
    limit = options.get("time_limit")
    return math.inf if limit is None else float(str(limit))


def folder_name(name: str, start: int) -> str:
    """What the folder of a run's results is called."""
    return name if start == 1 else f"{name}-{start}"


def jobs(
    inputs: Iterable[Input],
    starts: int,
    directory: Path,
    options: RelaxOptions,
    still: Mapping[str, Any],
    extrapolate: bool,
) -> list[Job]:
    """The runs of a batch; a MobiusFlowError tells where two would share a folder.

    ``still`` are the obstacles' files, pins and pin_tangents of all of them.
    """
    made = []
    obstacles = {str(Path(path).resolve()): _hash(Path(path)) for path in still["avoid"]}
    values = {**vars(options), **still, "avoid": obstacles}
    for each in inputs:
        sha256 = None if each.file is None else _hash(each.file)
        for start in range(1, starts + 1):
            folder = directory / folder_name(each.name, start)
            scrambled = None if start == 1 else options.seed + start
            file = None if each.file is None else str(each.file)
            made.append(Job(each.name, start, scrambled, file, sha256, str(folder), values, extrapolate))
    _check_folders(made)
    return made


def _check_folders(made: Iterable[Job]) -> None:
    """Case does not tell folders apart everywhere, and the tables are in the same directory."""
    count = Counter(job.folder.casefold() for job in made)
    for job in made:
        name = Path(job.folder).name
        if count[job.folder.casefold()] > 1 or name.casefold() in (CSV, PARQUET):
            raise MobiusFlowError(
                f"{job.file or job.name}: its results would not be the only ones in {name}; rename it"
            )


def _hash(path: Path) -> str | None:
    """Of a file's bytes; None for what no run can read: its own sentence comes from there."""
    try:
        return sha256_of(path) if path.stat().st_size <= MAX_BYTES else None
    except OSError:
        return None


def sha256_of(path: Path) -> str | None:
    """Of a regular file; None for all else, such as a pipe, which might never end."""
    if not path.is_file():
        return None
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()
