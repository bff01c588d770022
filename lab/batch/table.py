"""The table of a batch: a row for each run, as CSV and as Parquet."""

import csv
import hashlib
import io
import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import get_args, get_type_hints

from ... import __version__
from ...cli.terminal import one_line
from ...core import RelaxOptions
from ...core.base import atomic_write
from .job import CSV, PARQUET, Job, as_text, foreign, sha256_of

FAILED = "failed"
_MARK = b"mobius-flow batch"  # in the Parquet file's metadata: SHA-256 of the CSV beside it, and of the one before


@dataclass(frozen=True, kw_only=True)
class Row:
    """The outcome of one run; unknown values are None. The columns are described in docs/batch.md."""

    name: str
    start: int
    seed: int | None
    kind: str | None = None
    input_sha256: str | None = None
    type_before: str | None = None
    type_after: str | None = None
    proved: bool | None = None
    vertices: int | None = None
    energy: float | None = None
    extrapolated_energy: float | None = None
    extrapolated_energy_error: float | None = None
    gradient_norm: float | None = None
    index: int | None = None
    ropelength: float | None = None
    writhe: float | None = None
    average_crossing_number: float | None = None
    iterations: int | None = None
    fallback_steps: int | None = None
    seconds: float | None = None
    processor_seconds: float | None = None
    status: str
    message: str
    certified: bool | None = None
    verified: bool | None = None
    version: str = __version__
    options: str

    @classmethod
    def of(cls, job: Job, **values: object) -> "Row":
        """A row of a job."""
        known = {"name": job.name, "start": job.start, "seed": job.seed, "input_sha256": job.sha256}
        return cls(**known, options=given(job), **values)  # type: ignore[arg-type]

    @classmethod
    def failure(cls, job: Job, reason: str) -> "Row":
        """The row of a job without results."""
        return cls.of(job, status=FAILED, message=as_text(one_line(reason)))

    @property
    def failed(self) -> bool:
        """Whether there are no results."""
        return self.status == FAILED


def given(job: Job) -> str:
    """The options of a job that differ from the defaults, as JSON: it has no tuples, wherever they come from."""
    values = {**vars(RelaxOptions()), "avoid": {}, "pins": [], "pin_tangents": False}, job.options
    defaults, options = (json.loads(json.dumps(each)) for each in values)
    return json.dumps({name: value for name, value in options.items() if value != defaults[name]})


def in_order(rows: Iterable[Row]) -> list[Row]:
    """The rows, sorted by name and start."""
    return sorted(rows, key=lambda row: (row.name, row.start))


def save(rows: Iterable[Row], directory: Path) -> None:
    """Write both tables, each whole or not at all; an OutputError says why they cannot be written."""
    import pyarrow as pa
    import pyarrow.parquet

    check_tables(directory)
    cells = list(map(asdict, in_order(rows)))
    text = as_csv([field.name for field in fields(Row)], cells)
    mark = f"{hashlib.sha256(text).hexdigest()} {sha256_of(directory / CSV) or ''}"
    kinds = {str: pa.string(), int: pa.int64(), float: pa.float64(), bool: pa.bool_()}
    columns = [(name, kinds[(get_args(hint) or (hint,))[0]]) for name, hint in get_type_hints(Row).items()]
    stream = io.BytesIO()
    pyarrow.parquet.write_table(pa.Table.from_pylist(cells, pa.schema(columns, metadata={_MARK: mark})), stream)
    with atomic_write(directory / CSV) as table, atomic_write(directory / PARQUET) as parquet:
        table.write_bytes(text)
        parquet.write_bytes(stream.getvalue())


def check_tables(directory: Path) -> None:
    """Raise a MobiusFlowError if there are tables that no batch wrote, or that have been changed since.

    A CSV file has no room for a mark: it is in the metadata of the Parquet file, and proves both.
    """
    table, parquet = directory / CSV, directory / PARQUET
    marks = _marks(parquet) if parquet.exists() else []
    if parquet.exists() and not marks:
        raise foreign(parquet, "batch")
    if table.exists() and sha256_of(table) not in marks:
        raise foreign(table, "batch")


def _marks(parquet: Path) -> list[str]:
    """The mark of a Parquet file; empty if there is none, or it does not match the contents."""
    import pyarrow
    import pyarrow.parquet

    if not parquet.is_file():  # a pipe might never end
        return []
    try:
        table = pyarrow.parquet.read_table(io.BytesIO(parquet.read_bytes()))
    except pyarrow.ArrowException:
        return []
    marks = (table.schema.metadata or {}).get(_MARK, b"").decode("ascii", "replace").split()
    text = as_csv(table.column_names, table.to_pylist())
    return marks if marks and marks[0] == hashlib.sha256(text).hexdigest() else []


def as_csv(columns: Sequence[str], cells: Iterable[Mapping[str, object]], end: str = "\r\n") -> bytes:
    stream = io.StringIO(newline="")
    writer = csv.DictWriter(stream, columns, lineterminator=end)
    writer.writeheader()
    writer.writerows(cells)
    return stream.getvalue().encode()
