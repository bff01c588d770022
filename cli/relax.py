"""``mobius-flow relax``: a tangled curve in, a relaxed one out."""

import argparse
import json
import sys
from collections.abc import Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import NamedTuple

from ..addon.engine.playing import Playing
from ..addon.pictures.looks import DEFAULT, LOOKS
from ..core import Iterate, MobiusFlowError, RelaxOptions, Result, Status, Task, Trajectory, relax, write_curve
from ..core.driver import Relaxation, finish
from ..core.errors import counted
from . import curves, signals
from . import options as relax_options
from .places import OUTPUTS, Output, Write, admit, check_places, is_file, kept, output_for, writing
from .progress import progress

EXIT_STATUS = dict.fromkeys(Status, 0) | {Status.STALLED: 1, Status.INTERRUPTED: 130}
NAMED = 4  # meshes of a run that are listed individually
_PLAYED = {
    "--loop": "play the relaxation there and back",
    "--constant-radius": "draw the tube as thick throughout as where there is least room",
}
_EPILOG = """\
examples:
  mobius-flow relax knot.txt relaxed.obj --report report.json --trajectory path.npz
  mobius-flow relax knot.txt film.mp4 --look neon
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
30,000 vertices; beyond, "final_energy_error" bounds its relative error. "phases" are the meshes of the run: vertices,
iterations, seconds. "sampled_errors" are the errors of the hierarchical solver, estimated from the last sample of
edges. "pins" are the vertices of the result that were held, counted from 0 as in "options".
An output that cannot be written in the end is saved in a temporary directory, which the message names.
"""


def add_relax(parser: argparse.ArgumentParser) -> None:
    parser.description, parser.epilog = "Relax a curve: lower its energy without changing its knot type.", _EPILOG
    curves.add_input(parser, "polygons, closed or open")
    add_outputs(parser)
    relax_options.add_to(parser)
    relax_options.add_task(parser)
    parser.set_defaults(run=_run)


def add_outputs(parser: argparse.ArgumentParser) -> None:
    """Add the outputs: see `write_results`."""
    text = f"what to write, by suffix: {', '.join(OUTPUTS)}, or - for standard output"
    parser.add_argument("output", metavar="OUT", help=text)
    as_device = {curves.STREAM: curves.DEVICE}  # standard output, for reports and trajectories
    for name, metavar, text in (
        ("--report", "R.json", "write a report of the run as JSON; - is standard output"),
        ("--trajectory", "T.npz", "write the certified path, for mobius-flow verify; - is standard output"),
    ):
        parser.add_argument(name, type=lambda path: as_device.get(path, path), metavar=metavar, help=text)
    for name, text in _PLAYED.items():
        parser.add_argument(name, action="store_true", help=f"{text} (.mp4 and .blend)")
    parser.add_argument("--quiet", action="store_true", help="print nothing but errors")
    text = (
        f"stage and material of a scene, film or picture: {', '.join(name.lower() for name in LOOKS)} (default: "
        f"{DEFAULT.lower()}; films are then drawn plainly, in a tenth of the time)"
    )
    parser.add_argument("--look", type=relax_options.look, metavar="LOOK", help=text)


def _run(options: argparse.Namespace) -> int:
    """Relax, write every requested output, and return the exit status."""
    output = output_for(options.output, options.format, options.look, options.loop or options.constant_radius)
    wanted = relax_options.from_arguments(options)
    check_places(relax_options.inputs(options), places(options))
    file = curves.read(options.input, options.format)
    with curves.refusals(file):
        task = relax_options.task(options, file)
    admit(output, options.output, file.curve)
    respected = {"pins": task.pins, "pin_tangents": task.pin_tangents, "avoid": [each.name for each in task.obstacles]}
    origin = relax_options.provenance(vars(wanted) | respected, str(file.source.path), file.source.sha256)
    with curves.refusals(file):
        result, iterates = run_to_end(relax(task, wanted), task, wanted, output, options)
    write_results(options, output, result, iterates, origin)
    return EXIT_STATUS[result.status]


def places(options: argparse.Namespace) -> dict[str, str | None]:
    """The files that are written, by their names on the command line."""
    return {"OUT": options.output, "--report": options.report, "--trajectory": options.trajectory}


def run_to_end(
    relaxation: Relaxation, task: Task, wanted: RelaxOptions, output: Output, options: argparse.Namespace
) -> tuple[Result, list[Iterate]]:
    """Run to the end or an interrupt. Signals interrupt steps only: neither what is recorded nor the end is lost."""
    iterates: list[Iterate] = []
    recorded = output.is_scene or options.trajectory is not None
    signals.hold()
    with progress(wanted, _shown(options)) as draw:

        def on_iterate(iterate: Iterate) -> None:
            if recorded:
                iterates.append(iterate)
            if iterate.index == 0 and not options.quiet:
                options.notes.show()  # the curve is accepted: there will be no refusal
            draw(iterate)

        return finish(signals.interruptible(relaxation), task, wanted, on_iterate), iterates


def _shown(options: argparse.Namespace) -> bool:
    return not options.quiet and sys.stderr.isatty()


class _Job(NamedTuple):
    """A result to be written; see `kept`."""

    path: str
    write: Write
    rescue: Write | None = None
    name: str | None = None
    slow: bool = False  # may take long, or never end: it can be interrupted, and comes last

    def begin(self, interrupted: bool, path: str) -> None:
        """Write; long tasks are not begun after an interrupt."""
        if self.slow and interrupted:
            raise KeyboardInterrupt
        if self.slow:
            signals.allow()
        self.write(path)


def write_results(
    options: argparse.Namespace, output: Output, result: Result, iterates: list[Iterate], origin: Mapping[str, object]
) -> None:
    """Write every requested output, and report on standard error how the run ended, unless quiet."""
    # report, trajectory, and curve or scene: if one cannot be written, the others still are
    jobs = _jobs(options, output, result, iterates, origin)
    failures: list[str] = []
    interrupted = False
    for job in sorted(jobs, key=lambda job: job.slow):
        signals.hold()
        try:
            failures += kept(job.path, partial(job.begin, interrupted), job.rescue or job.write, job.name)
        except KeyboardInterrupt as interrupt:
            interrupted = True
            failures.append(str(interrupt))
    if interrupted:
        raise KeyboardInterrupt(f"interrupted: {'; '.join(failures)}")
    if failures:
        raise MobiusFlowError("; ".join(failures))
    signals.allow()
    if not options.quiet:
        print(_summary(result, falls="to" not in origin), file=sys.stderr)


def _jobs(
    options: argparse.Namespace, output: Output, result: Result, iterates: list[Iterate], origin: Mapping[str, object]
) -> Iterator[_Job]:
    def save_trajectory(path: str) -> None:
        trajectory = Trajectory(origin, result.task.obstacles)
        for iterate in iterates:
            trajectory.add(iterate)
        trajectory.save(path)

    extras = (options.report, partial(_write_report, result, origin)), (options.trajectory, save_trajectory)
    yield from (_Job(path, save, slow=not is_file(path)) for path, save in extras if path is not None)

    def write(path: str) -> None:
        playing = Playing(options.look, options.loop, options.constant_radius)
        output.write(path, result, iterates, _shown(options), playing)

    job = _Job(options.output, write)
    if output.is_scene:  # a film takes a minute
        plain = partial(write_curve, curve=result.curve)
        yield job._replace(rescue=plain, name=f"{Path(options.output).stem}.obj", slow=True)
    else:
        name = f"curve.{options.format or 'txt'}" if options.output == curves.STREAM else None
        yield job._replace(name=name, slow=not is_file(options.output))


def _write_report(result: Result, origin: Mapping[str, object], path: str) -> None:
    text = json.dumps(result.report() | dict(origin), indent=1) + "\n"
    with writing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def _summary(result: Result, falls: bool) -> str:
    """How a run ended; energies of a motion that does not fall are those at its ends, which it did not choose."""
    certified = "certified free of contact" if result.certified else "NOT certified"
    error = f" ± {result.final_energy_error * result.final_energy:.1g}" if result.final_energy_error else ""
    energy = f"Möbius energy {result.final_energy:.9g}{error}"
    iterations = counted(result.iterations, "iteration")
    if not falls:
        return f"{result.message}; {iterations}, {result.seconds:.1f} s, {certified}"
    return (
        f"{result.message}; objective {result.energies[0]:.6g} → {result.energies[-1]:.9g} in "
        f"{iterations}, {result.seconds:.1f} s{_phases(result)}, {energy}, {certified}"
    )


def _phases(result: Result) -> str:
    """How the time was spent on meshes, if there were several, but not very many."""
    if len(result.phases) > NAMED:
        return f" on {len(result.phases)} meshes"
    each = [f"{phase.iterations} with {phase.vertices} vertices, {phase.seconds:.1f} s" for phase in result.phases]
    if result.last.strand_moves and result.phases[0].iterations == 0:  # the given mesh saw nothing else
        each[0] = f"strand moves, {result.phases[0].seconds:.1f} s"
    return f" ({'; '.join(each)})" if len(each) > 1 else ""
