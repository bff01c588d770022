"""Results as batches write them, without the runs."""

from pathlib import Path
from types import MappingProxyType

import numpy as np
from mobius_flow.core import Curve, write_curve
from mobius_flow.lab.batch.folder import new_folder, write_report
from mobius_flow.lab.batch.job import CURVE, TRAJECTORY, Job, folder_name
from mobius_flow.lab.batch.table import Row
from mobius_flow.lab.smooth.fourier import FourierCurve

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
        np.savez(room / TRAJECTORY, stage_000=curve.vertices[None], component_sizes_000=curve.mesh.component_sizes)
        write_report(room, job, row, {} if smooth is None else {"smooth": smooth.as_lists})
    return folder
