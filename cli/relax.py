"""``mobius-flow relax``: a tangled curve in, a relaxed one out."""

import argparse
import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import NamedTuple

from ..core import (
    Iterate,
    MobiusFlowError,
    Obstacle,
    Outcome,
    RelaxOptions,
    Result,
    Status,
    Task,
    Trajectory,
    relax,
    write_curve,
)
from ..core.curve.io import FORMATS
from ..core.driver import Relaxation, finish
from ..core.errors import OptionError, OutputError, counted
from ..core.system.files import atomic_write
from . import curves, signals
from . import options as relax_options
from .notes import Notes
from .outputs import OUTPUTS, Output, admit, output_for
from .places import check_places, is_file
from .progress import Progress
from .provenance import provenance
from .recovery import Write, kept

EXIT_STATUS = dict.fromkeys(Status, 0) | {Status.STALLED: 1, Status.INTERRUPTED: 130}
KEYED = ("auto", "fixed", "finer")  # meshes that keyframes can follow
_DESCRIPTION = "Relax a curve: lower its energy without changing its knot type."
_EPILOG = """\
examples:
  mobius-flow relax knot.txt relaxed.obj --report report.json --trajectory path.npz
  mobius-flow relax knot.txt film.mp4 --method trust-region
  mobius-flow relax knot.txt relaxed.txt --avoid walls.obj --trajectory path.npz
  mobius-flow relax loop.obj relaxed.obj --pin 12,40
  mobius-flow knot 8_19 - | mobius-flow relax - - --format txt | mobius-flow energy -

exit status:
  0    it converged, or stopped at the given limit of iterations or seconds
  1    it is stuck, or pulls tight without limit, as composite knots do;
       the best curve, the report and the trajectory are written all the same
  2    bad input or bad options, or an output that cannot be written; one line says what and where
  130  interrupted by Ctrl-C, SIGTERM or SIGHUP; the best curve, the report and the trajectory are written

In the report "energy" is the objective at every iterate, "final_energy" the Möbius energy of the result, exact up to
30,000 vertices; beyond, "final_energy_error" bounds its relative error. "sampled_errors" are the errors of the
hierarchical solver, estimated from the last sample of edges. "pins" are the vertices of the result that were held,
counted from 0 as in "options".
An output that cannot be written in the end is saved in a temporary directory, which the message names.
"""


def add_to(parser: argparse.ArgumentParser) -> None:
    """Describe the subcommand."""
    parser.description, parser.epilog = _DESCRIPTION, _EPILOG
    parser.add_argument(
        "input", metavar="IN", help=f"polygons, closed or open: {', '.join(FORMATS)}, or - for standard input"
    )
    parser.add_argument(
        "output", metavar="OUT", help=f"what to write, by suffix: {', '.join(OUTPUTS)}, or - for standard output"
    )
    curves.add_format(parser)
    parser.add_argument(
        "--report", type=_extra, metavar="R.json", help="write a report of the run as JSON; - is standard output"
    )
    parser.add_argument(
        "--trajectory",
        type=_extra,
        metavar="T.npz",
        help="write the certified path, for mobius-flow verify; - is standard output",
    )
    parser.add_argument("--quiet", action="store_true", help="print nothing but errors")
    relax_options.add_to(parser)
    relax_options.add_task(parser)


def _extra(path: str) -> str:
    """Where a report or trajectory goes: a file, or as a device standard output."""
    return curves.DEVICE if path == curves.STREAM else path


def run(options: argparse.Namespace) -> int:
    """Relax, write every requested output, and return the exit status."""
    output = output_for(options.output, options.format)
    wanted = relax_options.from_arguments(options)
    if output.needs_iterates:
        if wanted.mesh not in KEYED:
            raise OptionError(
                f"{options.output}: keyframes cannot follow mesh={wanted.mesh!r}; "
                "leave --mesh out, or write a curve file"
            )
        wanted = wanted.keyed
    outputs = {"OUT": options.output, "--report": options.report, "--trajectory": options.trajectory}
    check_places(relax_options.inputs(options), outputs)
    file = curves.read(options.input, options.format)
    with curves.refusals(file):
        task = relax_options.task(options, file)
    admit(output, options.output, file.curve)
    origin = provenance(wanted, task, file)
    with curves.refusals(file):
        result, iterates = _relax(task, wanted, output, options)
    _write_all(options, output, result, iterates, origin)
    if not options.quiet:
        print(_summary(result), file=sys.stderr)
    return EXIT_STATUS[result.status]


def _relax(
    task: Task, wanted: RelaxOptions, output: Output, options: argparse.Namespace
) -> tuple[Result, list[Iterate]]:
    """Run to the end or an interrupt. Signals interrupt steps only: neither what is recorded nor the end is lost."""
    iterates: list[Iterate] = []
    recorded = output.needs_iterates or options.trajectory is not None
    notes: Notes = options.notes
    relaxation = relax(task, wanted)
    signals.hold()
    with Progress(wanted, shown=not options.quiet and sys.stderr.isatty()) as progress:

        def on_iterate(iterate: Iterate) -> None:
            if recorded:
                iterates.append(iterate)
            if iterate.index == 0 and not options.quiet:
                notes.show()  # the curve is accepted: there will be no refusal
            progress.update(iterate)

        return finish(_interruptible(relaxation), task, wanted, on_iterate), iterates


def _interruptible(relaxation: Relaxation) -> Relaxation:
    """The same, interrupted by signals while it computes, and only then."""
    while True:
        signals.allow()
        try:
            iterate = next(relaxation)
        except StopIteration as end:
            signals.hold()
            outcome: Outcome = end.value
            return outcome
        signals.hold()
        yield iterate


class _Job(NamedTuple):
    """A result to be written; see `kept`. Those that may take long, or never end, can be interrupted, and come last."""

    path: str
    write: Write
    rescue: Write | None = None
    name: str | None = None
    interruptible: bool = False

    def begin(self, path: str) -> None:
        """Write, and let signals interrupt it if it takes long."""
        if self.interruptible:
            signals.allow()
        self.write(path)


def _write_all(
    options: argparse.Namespace, output: Output, result: Result, iterates: list[Iterate], origin: Mapping[str, object]
) -> None:
    """Write report, trajectory and curve or scene: the others are written all the same where one cannot be."""
    failures: list[str] = []
    interrupted = False
    for job in sorted(_jobs(options, output, result, iterates, origin), key=lambda job: job.interruptible):
        signals.hold()
        try:
            write = _give_up if interrupted and job.interruptible else job.begin
            failures += kept(job.path, write, job.rescue or job.write, job.name)
        except KeyboardInterrupt as interrupt:
            interrupted = True
            failures.append(str(interrupt))
    if interrupted:
        raise KeyboardInterrupt(f"interrupted: {'; '.join(failures)}")
    if failures:
        raise MobiusFlowError("; ".join(failures))
    signals.allow()


def _give_up(_path: str) -> None:
    """What takes long is not begun after an interrupt."""
    raise KeyboardInterrupt


def _jobs(
    options: argparse.Namespace, output: Output, result: Result, iterates: list[Iterate], origin: Mapping[str, object]
) -> Iterator[_Job]:
    for path, write in (
        (options.report, lambda path: _write_report(path, result, origin)),
        (options.trajectory, lambda path: _trajectory(iterates, origin, result.task.obstacles).save(path)),
    ):
        if path is not None:
            yield _Job(path, write, interruptible=not is_file(path))
    shown = not options.quiet and sys.stderr.isatty()
    job = _Job(options.output, lambda path: output.write(path, result, iterates, shown))
    if output.needs_iterates:  # a film takes a minute
        plain = partial(write_curve, curve=result.curve)
        yield job._replace(rescue=plain, name=f"{options.output}.obj", interruptible=True)
    else:
        name = f"curve.{options.format or 'txt'}" if options.output == curves.STREAM else None
        yield job._replace(name=name, interruptible=not is_file(options.output))


def _trajectory(iterates: list[Iterate], origin: Mapping[str, object], obstacles: Sequence[Obstacle]) -> Trajectory:
    trajectory = Trajectory(origin, obstacles)
    for iterate in iterates:
        trajectory.add(iterate)
    return trajectory


def _write_report(path: str, result: Result, origin: Mapping[str, object] | None = None) -> None:
    text = json.dumps(result.report() | dict(origin or {}), indent=1) + "\n"
    try:
        with atomic_write(path) as temporary:
            temporary.write_text(text, encoding="utf-8")
    except (OSError, ValueError) as error:
        raise OutputError(path, error) from error


def _summary(result: Result) -> str:
    certified = "certified free of contact" if result.certified else "NOT certified"
    error = f" ± {result.final_energy_error * result.final_energy:.1g}" if result.final_energy_error else ""
    energy = f"Möbius energy {result.final_energy:.9g}{error}"
    return (
        f"{result.message}; objective {result.energies[0]:.6g} → {result.energies[-1]:.9g} in "
        f"{counted(len(result.energies) - 1, 'iteration')}, {result.seconds:.1f} s, {energy}, {certified}"
    )
