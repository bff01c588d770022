"""One run of a batch, from its start to its folder of results."""

import time
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Any

from ... import __version__
from ...core import (
    Curve,
    MobiusFlowError,
    RelaxOptions,
    Result,
    Task,
    Trajectory,
    minimize,
    read_obstacle,
    write_curve,
)
from ...core.collision import check_embedded
from ...core.curve.io import CurveFile, load_curve
from ...core.extrapolation import extrapolated
from ...core.knots import knot, knot_type, scramble
from ...core.units import check_units
from ...core.verify import verify
from .. import curves
from ..main import explained
from ..provenance import environment
from .folder import check_name, new_folder, write_report
from .job import CURVE, STILL, TRAJECTORY, Job
from .table import Row

GAP = 0.5  # of the mean edge length that scrambled strands keep: nearer ones would need thousands of vertices


def relaxed(job: Job) -> Row:
    """Do a run; whatever goes wrong is told by its row."""
    try:
        if job.version != __version__:
            raise MobiusFlowError(f"a worker has version {__version__} of mobius-flow, and {job.version} is wanted")
        return _relaxed(job)
    except Exception as error:
        return Row.failure(job, explained(error)[0])


def _relaxed(job: Job) -> Row:
    began = time.perf_counter()
    check_name(Path(job.folder))
    values: dict[str, Any] = {name: value for name, value in job.options.items() if name not in STILL}
    options = RelaxOptions(**values)
    file = None if job.file is None else _load(job.file)
    if file is not None:
        job = replace(job, sha256=file.source.sha256)  # of what is really relaxed
    origin = {"options": job.options, "input": {"name": job.file or job.name, "sha256": job.sha256}, **environment()}
    with nullcontext() if file is None else curves.refusals(file):
        task = _task(job, file)
        trajectory = Trajectory(origin, task.obstacles)
        result = minimize(task, options, trajectory.add)
    found = _findings(job, options, task.curve, result)
    with new_folder(Path(job.folder)) as room:
        write_curve(room / CURVE, result.curve)
        trajectory.save(room / TRAJECTORY)
        verified = verify(room / TRAJECTORY).accepted
        row = Row.of(job, **found, verified=verified, seconds=time.perf_counter() - began)
        write_report(room, job, row, result.report() | origin)
    return row


def _task(job: Job, file: CurveFile | None) -> Task:
    """The start with its obstacles, which are read, and its pins, by a file's own numbers if it has some."""
    still: dict[str, Any] = {name: job.options[name] for name in STILL}
    pins = tuple(still["pins"] if file is None else map(file.index_of, still["pins"]))
    start = _start(knot(job.name) if file is None else file.curve, job.seed)
    obstacles = tuple(map(read_obstacle, still["avoid"]))
    return Task(curve=start, obstacles=obstacles, pins=pins, pin_tangents=still["pin_tangents"])


def _load(path: str) -> CurveFile:
    """Read a curve file; a CurveFileError tells why it cannot be read."""
    curves.check_regular(path)
    return load_curve(path)


def _start(curve: Curve, seed: int | None) -> Curve:
    """The curve itself, or scrambled by a seed."""
    if seed is None:
        return curve
    check_units(curve)
    check_embedded(curve)
    return scramble(curve, seed, gap=GAP * float(curve.edge_lengths.mean()))


def _findings(job: Job, options: RelaxOptions, start: Curve, result: Result) -> dict[str, object]:
    """What the row tells of a result."""
    smooth = None
    if job.extrapolate and result.outcome.converged:
        end = replace(result.task, curve=result.curve, pins=result.last.pins, pin_tangents=False)
        smooth = extrapolated(end, options)
    return {
        "type_before": str(knot_type(start)),
        "type_after": str(knot_type(result.curve)),
        "vertices": len(result.curve),
        "energy": result.final_energy,
        "extrapolated_energy": smooth and smooth.value,
        "extrapolated_energy_error": smooth and smooth.error,
        "gradient_norm": result.last.gradient_norm,
        "index": result.outcome.negative_eigenvalues,
        "status": result.status.value,
        "message": result.message,
        "certified": result.certified,
    }
