"""The table of a batch: a row for each run, as CSV and as Parquet."""

import csv
import json
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import get_args, get_type_hints

from ... import __version__
from ...core import RelaxOptions
from ...core.errors import OutputError, counted
from ...core.system.files import atomic_write
from ..streams import one_line
from .job import CSV, PARQUET, Job

FAILED = "failed"


@dataclass(frozen=True, kw_only=True)
class Row:
    """What became of one run; what is not known is None.

    Attributes
    ----------
    name, start, seed
        As in its `Job`.
    type_before, type_after
        Of the start and the end, as `mobius-flow info` tells them: ``m3_1``, ``3_1#4_1``, or ``not told``.
    vertices
        Of the end.
    energy
        Möbius energy of the end.
    extrapolated_energy, extrapolated_energy_error
        Of the smooth curve, and how far that may be off.
    gradient_norm
        Of the projected gradient at the end.
    index
        Number of the Hessian's negative eigenvalues, where that was asked for: 0 at a minimum, more at a saddle.
    seconds
        Of the whole run, by the clock.
    status, message
        How it ended: as a report has it, or failed and why.
    certified
        Whether every motion was proved free of contact on the way.
    verified
        Whether the trajectory that was written is accepted by the independent check.
    version, options
        Of the program, and those options that are not the default, as JSON.
    """

    name: str
    start: int
    seed: int | None
    type_before: str | None = None
    type_after: str | None = None
    vertices: int | None = None
    energy: float | None = None
    extrapolated_energy: float | None = None
    extrapolated_energy_error: float | None = None
    gradient_norm: float | None = None
    index: int | None = None
    seconds: float | None = None
    status: str
    message: str
    certified: bool | None = None
    verified: bool | None = None
    version: str = __version__
    options: str

    @classmethod
    def of(cls, job: Job, **values: object) -> "Row":
        """A row of a job."""
        nothing = {"avoid": {}, "pins": [], "pin_tangents": False}
        defaults, options = _plain(vars(RelaxOptions()) | nothing), _plain(job.options)
        given = {name: value for name, value in options.items() if value != defaults[name]}
        return cls(name=job.name, start=job.start, seed=job.seed, options=json.dumps(given), **values)  # type: ignore[arg-type]

    @classmethod
    def failure(cls, job: Job, reason: str) -> "Row":
        """The row of a job without results."""
        return cls.of(job, status=FAILED, message=one_line(reason))

    @property
    def failed(self) -> bool:
        """Whether there are no results."""
        return self.status == FAILED


def _plain(options: Mapping[str, object]) -> dict[str, object]:
    """Options as JSON has them, wherever they come from: it has no tuples."""
    plain: dict[str, object] = json.loads(json.dumps(dict(options)))
    return plain


class Table:
    """Rows in order of name and start."""

    def __init__(self, rows: Iterable[Row]) -> None:
        self.rows = sorted(rows, key=lambda row: (row.name, row.start))

    def summary(self) -> str:
        """How many runs ended in which way."""
        ends = Counter(row.status.replace("_", " ") for row in self.rows)
        return f"{counted(len(self.rows), 'run')}: " + ", ".join(f"{count} {end}" for end, count in ends.most_common())

    def save(self, directory: Path) -> None:
        """Write both files, each whole or not at all; an OutputError says why one cannot be."""
        for name, write in ((CSV, self._write_csv), (PARQUET, self._write_parquet)):
            path = directory / name
            try:
                with atomic_write(path) as temporary:
                    write(temporary)
            except OSError as error:
                raise OutputError(path, error) from error

    def _write_csv(self, path: Path) -> None:
        with path.open("w", encoding="utf-8", newline="") as stream:
            writer = csv.DictWriter(stream, [field.name for field in fields(Row)])
            writer.writeheader()
            writer.writerows(map(asdict, self.rows))

    def _write_parquet(self, path: Path) -> None:
        import pyarrow as pa
        import pyarrow.parquet as pq

        kinds = {str: pa.string(), int: pa.int64(), float: pa.float64(), bool: pa.bool_()}
        columns = [(name, kinds[(get_args(hint) or (hint,))[0]]) for name, hint in get_type_hints(Row).items()]
        pq.write_table(pa.Table.from_pylist(list(map(asdict, self.rows)), pa.schema(columns)), path)
