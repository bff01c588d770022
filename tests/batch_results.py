"""Results as batches write them, without the runs."""

from pathlib import Path
from types import MappingProxyType

from mobius_flow.cli.batch.folder import new_folder, write_report
from mobius_flow.cli.batch.job import CURVE, TRAJECTORY, Job, folder_name
from mobius_flow.cli.batch.table import Row
from mobius_flow.core import Curve, write_curve
from mobius_flow.core.curve.fourier import FourierCurve

_ENDED = MappingProxyType({"status": "converged", "message": "", "options": "{}", "certified": True, "verified": True})


def write_run(
    directory: Path, name: str, start: int, curve: Curve, smooth: FourierCurve | None = None, **columns: object
) -> Path:
    """A folder of results, which is returned."""
    directory.mkdir(exist_ok=True)
    seed = None if start == 1 else start
    folder = directory / folder_name(name, start)
    job = Job(name, start, seed, None, None, str(folder), {}, smooth is not None)
    row = Row(**{"name": name, "start": start, "seed": seed, **_ENDED, **columns})
    with new_folder(folder) as room:
        write_curve(room / CURVE, curve)
        (room / TRAJECTORY).write_bytes(b"")
        write_report(room, job, row, {} if smooth is None else {"smooth": smooth.as_lists})
    return folder
