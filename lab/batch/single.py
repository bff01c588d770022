"""One run of a batch, from its start to its folder of results."""

import time
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Any

from ... import __version__
from ...cli import curves
from ...cli.main import explained
from ...cli.options import provenance
from ...cli.terminal import one_line
from ...core import (
    CurveError,
    MobiusFlowError,
    RelaxOptions,
    Result,
    Task,
    Trajectory,
    minimize,
    read_obstacle,
)
from ...core.base.errors import OutputError
from ...core.collision import check_embedded, thickness
from ...core.curve.measures import writhe_and_crossings
from ...core.descent.task import check_units
from ...core.driver import finish
from ...core.driver.info import PAIRS_UP_TO
from ...core.io import FORMATS, CurveFile, load_curve
from ...core.knots import knot_type
from ...core.proof import verify
from ...core.ropes import TightenOptions, tightening
from ..extrapolation import Extrapolation, extrapolated
from ..smooth.rest import RestingCurve, at_rest
from ..starts import scrambled, start
from .folder import finished, new_folder, write_report, write_text
from .job import CURVE, STILL, TIGHT, TRAJECTORY, Job
from .table import Row, given


def relaxed(job: Job) -> Row:
    """Do a run; errors go into its row, except an OutputError, which is about the place of all results."""
    try:
        if job.version != __version__:
            raise MobiusFlowError(f"a worker has version {__version__} of mobius-flow, and {job.version} is wanted")
        return finished(job) or _relaxed(job)  # another batch, or one that was killed, may have done it meanwhile
    except OutputError:
        raise
    except Exception as error:
        return Row.failure(job, explained(error)[0])


def _relaxed(job: Job) -> Row:
    clocks = time.perf_counter, time.process_time
    began = [clock() for clock in clocks]
    values: dict[str, Any] = {name: value for name, value in job.options.items() if name not in STILL}
    options, file = RelaxOptions(**values), None
    if job.file is not None:
        curves.check_regular(job.file)
        file = load_curve(job.file)
        job = replace(job, sha256=file.source.sha256)  # of the file that is really relaxed
    origin = provenance(job.options, job.file or job.name, job.sha256)
    with nullcontext() if file is None else curves.refusals(file):
        kind, task = _task(job, file)
        trajectory = Trajectory(origin, task.obstacles)
        if job.tight:
            wanted = {name: getattr(options, name) for name in ("vertices", "seed", "time_limit")}
            result = finish(tightening(task, TightenOptions(starts=job.tight, **wanted)), task, trajectory.add)
        else:
            result = minimize(task, options, trajectory.add)
    smooth = _smooth(job, options, result)
    curve, after = result.curve, knot_type(result.curve)
    few = len(curve) <= PAIRS_UP_TO
    writhe, crossings = writhe_and_crossings(curve) if few and curve.dimension == 3 else (None, None)
    found = {
        "kind": TIGHT if job.tight else kind,
        "type_before": str(knot_type(task.curve)),
        "type_after": str(after),
        "proved": after.proved,
        "vertices": len(curve),
        "energy": None if job.tight else result.final_energy,
        "gradient_norm": result.last.gradient_norm,
        "index": result.outcome.negative_eigenvalues,
        "ropelength": curve.length / thickness(curve) if few else None,
        "writhe": writhe,
        "average_crossing_number": crossings,
        "iterations": result.iterations,
        "fallback_steps": len(result.fallback_steps),
        "status": result.status.value,
        "message": result.message,
        "certified": result.certified,
        "extrapolated_energy": smooth and smooth.energy,
        "extrapolated_energy_error": smooth and smooth.error,
    }
    name = one_line(job.name) + ("" if job.seed is None else f", {kind} with seed {job.seed}")
    measure = f"ropelength {found['ropelength']:.9g}" if job.tight else f"Möbius energy {found['energy']:.9g}"
    head = (
        f"# {name}: {found['type_after']}, {measure}, {found['status']}\n"
        f"# mobius-flow {job.version} batch, options {given(job)}\n"
    )
    try:
        with new_folder(Path(job.folder)) as room:
            write_text(room / CURVE, head + FORMATS[".txt"].text(result.curve))
            trajectory.save(room / TRAJECTORY)
            verified = verify(room / TRAJECTORY).accepted
            seconds, processor = (clock() - start for clock, start in zip(clocks, began, strict=True))
            row = Row.of(job, **found, verified=verified, seconds=seconds, processor_seconds=processor)
            shape = {"smooth": smooth.curve.as_lists} if isinstance(smooth, RestingCurve) else {}
            write_report(room, job, row, result.report() | origin | shape)
    except (OSError, OutputError) as error:
        cause = error.__cause__ if isinstance(error.__cause__, OSError) else error  # others name files that are gone
        raise OutputError(job.folder, cause) from error
    return row


def _task(job: Job, file: CurveFile | None) -> tuple[str, Task]:
    """The start and its kind, with its obstacles, which are read, and its pins, in the file's own numbering."""
    still: dict[str, Any] = {name: job.options[name] for name in STILL}
    pins = tuple(still["pins"] if file is None else map(file.index_of, still["pins"]))
    kind, curve = start(job.name, job.start, job.seed or 0) if file is None else ("file", file.curve)
    if curve.dimension > 3:
        raise CurveError(
            f"the curve is in dimension {curve.dimension}, and {CURVE} holds curves of dimension 2 or 3: "
            "use mobius-flow relax, with an output in .json"
        )
    if file is not None and job.seed is not None:
        check_units(curve)
        check_embedded(curve)
        kind, curve = scrambled(curve, job.seed)
    obstacles = tuple(map(read_obstacle, still["avoid"]))
    return kind, Task(curve=curve, obstacles=obstacles, pins=pins, pin_tangents=still["pin_tangents"])


def _smooth(job: Job, options: RelaxOptions, result: Result) -> RestingCurve | Extrapolation | None:
    """The limit of ever finer meshes, if asked for: as a smooth curve at rest, or among obstacles from three meshes."""
    if not (job.extrapolate and result.outcome.converged):
        return None
    end = replace(result.task, curve=result.curve, pins=result.last.pins, pin_tangents=False)
    free = not (end.pins or end.obstacles or options.terms) and options.energy == RelaxOptions().energy
    closed = result.curve.dimension == 3 and not len(result.curve.mesh.ends)
    return (at_rest(result.curve) if free and closed else None) or extrapolated(end, options)
