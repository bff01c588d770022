"""One run of a batch, from its start to its folder of results."""

import time
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Any

from ... import __version__
from ...core import Curve, CurveError, MobiusFlowError, RelaxOptions, Result, Task, Trajectory, minimize, read_obstacle
from ...core.collision import check_embedded
from ...core.collision.gap import thickness
from ...core.curve.io import FORMATS, CurveFile, load_curve
from ...core.curve.measures import writhe_and_crossings
from ...core.errors import OutputError
from ...core.extrapolation import extrapolated
from ...core.info import PAIRS_UP_TO
from ...core.knots import knot, knot_type, scramble
from ...core.units import check_units
from ...core.verify import verify
from .. import curves
from ..main import explained
from ..options import provenance
from ..streams import one_line
from .folder import new_folder, write_report, write_text
from .job import CURVE, STILL, TRAJECTORY, Job
from .table import Row, given

GAP = 0.5  # of the mean edge length that scrambled strands keep: nearer ones would need thousands of vertices


def relaxed(job: Job) -> Row:
    """Do a run; its row says what goes wrong, but for an OutputError, which is about the place of all results."""
    try:
        if job.version != __version__:
            raise MobiusFlowError(f"a worker has version {__version__} of mobius-flow, and {job.version} is wanted")
        return _relaxed(job)
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
        job = replace(job, sha256=file.source.sha256)  # of what is really relaxed
    origin = provenance(job.options, job.file or job.name, job.sha256)
    with nullcontext() if file is None else curves.refusals(file):
        task = _task(job, file)
        trajectory = Trajectory(origin, task.obstacles)
        result = minimize(task, options, trajectory.add)
    found = _findings(job, options, task.curve, result)
    name = one_line(job.name) + ("" if job.seed is None else f", scrambled with seed {job.seed}")
    head = (
        f"# {name}: {found['type_after']}, Möbius energy {found['energy']:.9g}, {found['status']}\n"
        f"# mobius-flow {job.version} batch, options {given(job)}\n"
    )
    try:
        with new_folder(Path(job.folder)) as room:
            write_text(room / CURVE, head + FORMATS[".txt"].text(result.curve))
            trajectory.save(room / TRAJECTORY)
            verified = verify(room / TRAJECTORY).accepted
            seconds, processor = (clock() - start for clock, start in zip(clocks, began, strict=True))
            row = Row.of(job, **found, verified=verified, seconds=seconds, processor_seconds=processor)
            write_report(room, job, row, result.report() | origin)
    except (OSError, OutputError) as error:
        cause = error.__cause__ if isinstance(error.__cause__, OSError) else error  # others name files that are gone
        raise OutputError(job.folder, cause) from error
    return row


def _task(job: Job, file: CurveFile | None) -> Task:
    """The start, scrambled or not, with its obstacles, which are read, and its pins, by a file's own numbers."""
    still: dict[str, Any] = {name: job.options[name] for name in STILL}
    pins = tuple(still["pins"] if file is None else map(file.index_of, still["pins"]))
    start = knot(job.name) if file is None else file.curve
    if start.dimension > 3:
        raise CurveError(
            f"the curve is in dimension {start.dimension}, and {CURVE} holds curves of dimension 2 or 3: "
            "use mobius-flow relax, with an output in .json"
        )
    if job.seed is not None:
        check_units(start)
        check_embedded(start)
        start = scramble(start, job.seed, gap=GAP * float(start.edge_lengths.mean()))
    obstacles = tuple(map(read_obstacle, still["avoid"]))
    return Task(curve=start, obstacles=obstacles, pins=pins, pin_tangents=still["pin_tangents"])


def _findings(job: Job, options: RelaxOptions, start: Curve, result: Result) -> dict[str, object]:
    """What the row says of a result."""
    smooth = None
    if job.extrapolate and result.outcome.converged:
        end = replace(result.task, curve=result.curve, pins=result.last.pins, pin_tangents=False)
        smooth = extrapolated(end, options)
    curve, kind = result.curve, knot_type(result.curve)
    few = len(curve) <= PAIRS_UP_TO
    writhe, crossings = writhe_and_crossings(curve) if few and curve.dimension == 3 else (None, None)
    return {
        "type_before": str(knot_type(start)),
        "type_after": str(kind),
        "proved": kind.proved,
        "vertices": len(curve),
        "energy": result.final_energy,
        "extrapolated_energy": smooth and smooth.value,
        "extrapolated_energy_error": smooth and smooth.error,
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
    }
