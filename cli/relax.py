"""``mobius-flow relax``: a tangled curve in, a relaxed one out."""

import argparse
import json
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from ..core import Curve, Iterate, MobiusFlowError, RelaxOptions, Result, Status, Task, Trajectory, relax
from ..core.base import counted, write_file
from ..core.descent.task import centred
from ..core.driver import Relaxation, finish
from ..core.driver.run import gradient_bound
from ..core.energies.hierarchy import moebius_energy
from ..core.io import CurveFile, written_formats
from ..core.keys.figure import contact_map
from ..core.keys.key_options import Playing
from ..core.keys.paper import PAPERS
from . import curves, signals
from . import options as relax_options
from .options import DEFAULT, LOOKS
from .parser import further
from .places import (
    OUTPUTS,
    Write,
    check_holds,
    check_output,
    check_places,
    export,
    is_file,
    is_scene,
    kept,
)
from .progress import live, progress
from .terminal import GREEN, RED, YELLOW, command, digits, power, quoted, report

EXIT_STATUS = dict.fromkeys(Status, 0) | {Status.STALLED: 1, Status.INTERRUPTED: 130}
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
"""
_REPORT = """\
"energy" is the objective at every iterate, "final_energy" the Möbius energy of the result, exact up to 30,000
vertices; beyond, "final_energy_error" bounds its relative error. "phases" are the meshes of the run: vertices,
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
    further(parser, "the report", _REPORT)
    parser.set_defaults(run=_run)


def add_outputs(parser: argparse.ArgumentParser) -> None:
    """Add the outputs: see `write_results`; contacts are those of ropes that were pulled tight."""
    parser.set_defaults(contacts=None)
    text = f"what to write, by suffix: {', '.join(OUTPUTS)}, or - for standard output"
    parser.add_argument("output", metavar="OUT", help=text)
    as_device = {curves.STREAM: curves.DEVICE}  # standard output, for reports and trajectories
    for name, metavar, text in (
        ("--report", "R.json", "write a report of the run as JSON; - is standard output"),
        ("--trajectory", "T.npz", "write the certified path, for mobius-flow verify; - is standard output"),
    ):
        parser.add_argument(name, type=lambda path: as_device.get(path, path), metavar=metavar, help=text)
    parser.add_argument("--quiet", action="store_true", help="print nothing but errors")
    films = further(parser, "films and pictures")
    text = "play the relaxation there and back (.mp4 and .blend)"
    films.add_argument("--loop", action="store_true", help=text)
    text = "draw the tube as thick throughout as where there is least room (.mp4 and .blend)"
    films.add_argument("--constant-radius", action="store_true", help=text)
    text = (
        f"stage and material of a scene, film or picture: {', '.join(name.lower() for name in LOOKS)} (default: "
        f"{DEFAULT.lower()}; films are then drawn plainly, in a tenth of the time)"
    )
    films.add_argument("--look", type=relax_options.look, metavar="LOOK", help=text)


def _run(options: argparse.Namespace) -> int:
    wanted = relax_options.from_arguments(options)
    return carry_out(options, vars(wanted.resolved), lambda task: relax(task, wanted), wanted)


def carry_out(
    options: argparse.Namespace,
    settings: Mapping[str, object],
    begin: Callable[[Task], Relaxation],
    wanted: RelaxOptions | None = None,
) -> int:
    """Do something to the input with its pins and obstacles, and write the results, once it is known that they can be.

    ``settings``: as reports have them; ``wanted``: as for `run_to_end`.  Returns the exit status.
    """
    check_output(options.output, options.format, options.look, options.loop or options.constant_radius)
    check_places(relax_options.inputs(options), places(options))
    file = curves.read(options.input, options.format)
    with curves.refusals(file):
        task = relax_options.task(options, file)
    check_holds(options.output, options.format, file.curve)
    with curves.refusals(file):
        result, iterates = run_to_end(begin(task), task, options, wanted)
    return write_results(options, result, iterates, provenance(settings, task, file))


def places(options: argparse.Namespace) -> dict[str, str | None]:
    """The files that are written, by their names on the command line."""
    named = {f"--{name}": getattr(options, name) for name in ("report", "trajectory", "contacts")}
    return {"OUT": options.output, **named}


def provenance(settings: Mapping[str, object], task: Task, file: CurveFile) -> dict[str, object]:
    """The provenance of a result, with what the task adds to the options."""
    respected = {"pins": task.pins, "pin_tangents": task.pin_tangents, "avoid": [each.name for each in task.obstacles]}
    return relax_options.provenance({**settings, **respected}, str(file.source.path), file.source.sha256)


def run_to_end(
    relaxation: Relaxation, task: Task, options: argparse.Namespace, wanted: RelaxOptions | None = None
) -> tuple[Result, list[Iterate]]:
    """Run to the end or an interrupt. Signals interrupt steps only: neither what is recorded nor the end is lost."""
    iterates: list[Iterate] = []
    recorded = is_scene(options.output) or options.trajectory is not None
    signals.hold()
    with progress(wanted, not options.quiet and sys.stderr.isatty()) as draw:

        def on_iterate(iterate: Iterate) -> None:
            if recorded or not iterates:  # what is said begins with the first
                iterates.append(iterate)
            if iterate.index == 0 and not options.quiet:
                options.notes.show()  # the curve is accepted: there will be no refusal
            draw(iterate)

        return finish(signals.interruptible(relaxation), task, on_iterate), iterates


def write_results(
    options: argparse.Namespace, result: Result, iterates: list[Iterate], origin: Mapping[str, object]
) -> int:
    """Write every requested output, report on standard error how the run ended, unless quiet, and return the status.

    If one cannot be written, the others still are. Files come first: a film takes a minute, and a stream may never
    end, so that these can be interrupted; they are not begun after an interrupt.
    """
    struts: Any = getattr(result.outcome, "struts", None)  # of a rope that was pulled tight to the end
    if options.contacts and struts is None:
        unknown = "no map of contacts is written, as forces are not in equilibrium yet"
        result = replace(result, outcome=result.outcome.adding(unknown))
    origin = {**origin, **result.outcome.facts}

    def report_as_json(path: str) -> None:
        text = json.dumps(result.report() | origin, indent=1) + "\n"
        write_file(path, text.encode())

    def trajectory(path: str) -> None:
        made = Trajectory(origin, result.task.obstacles)
        for iterate in iterates:
            made.add(iterate)
        made.save(path)

    def contacts(path: str) -> None:
        write_file(path, PAPERS[Path(path).suffix.lower()](contact_map(result.curve, struts)))

    def output(path: str) -> None:
        playing, suffix = Playing(options.look, options.loop, options.constant_radius), Path(path).suffix.lower()
        if suffix == ".blend":
            export.write_blend(path, iterates, playing)
        elif suffix == ".png":
            export.write_still(path, iterates, options.look)
        elif suffix == ".mp4":
            with live(not options.quiet and sys.stderr.isatty()) as show:
                said = "frame {} of {} is drawn".format
                export.write_movie(path, iterates, lambda done, total: show(said(done, total)), playing)
        else:
            curves.write(path, result.curve, options.format)

    def patiently(write: Write) -> Write:
        def begin(path: str) -> None:
            if interrupted:
                raise KeyboardInterrupt
            signals.allow()
            write(path)

        return begin

    scene, name = is_scene(options.output), None
    if scene or options.output == curves.STREAM:  # of what is kept
        name = f"{Path(options.output).stem}.obj" if scene else f"curve.{options.format or 'txt'}"
    extras = [(options.report, report_as_json), (options.trajectory, trajectory)]
    extras += [] if struts is None else [(options.contacts, contacts)]
    jobs: list[tuple[str, Write, str | None]]
    jobs = [(path, write, None) for path, write in extras if path is not None]
    jobs.append((options.output, output, name))  # of a film that is not written the curve is kept, by the name's suffix
    slow = {path: not is_file(path) or (scene and path == options.output) for path, *_ in jobs}
    failures: list[str] = []
    interrupted = False
    for path, write, name in sorted(jobs, key=lambda job: slow[job[0]]):
        signals.hold()
        try:
            failures += kept(path, patiently(write) if slow[path] else write, write, name)
        except KeyboardInterrupt as interrupt:
            interrupted = True
            failures.append(str(interrupt))
    if interrupted:
        raise KeyboardInterrupt(f"interrupted: {'; '.join(failures)}")
    if failures:
        raise MobiusFlowError("; ".join(failures))
    signals.allow()
    if not options.quiet:
        written = [path for path, *_ in jobs[-1:] + jobs[:-1] if path not in (curves.STREAM, curves.DEVICE)]
        print(_said(options, result, iterates[0], written), file=sys.stderr)
    return EXIT_STATUS[result.status]


def _said(options: argparse.Namespace, result: Result, start: Iterate, written: Sequence[str]) -> str:
    """How a run ended, what it reached, what was written, and what to do next.

    Energies have the digits that the mesh leaves them; those of a motion that does not fall are no achievement.
    """
    falls, failed = options.command == "relax", EXIT_STATUS[result.status] != 0
    mark, colour = ("✓", GREEN) if result.outcome.converged else ("✗", RED) if failed else ("–", YELLOW)
    took = counted(result.iterations, "iteration"), f"{result.seconds:.1f} s", f"{len(result.curve)} vertices"
    reason, *notes = result.outcome.clauses
    told = "" if falls and result.outcome.converged else str(reason).partition(": ")[2] or reason
    following = ["verify", options.trajectory] if options.trajectory in written else []
    if not following and Path(options.output).suffix.lower() in written_formats():
        following = ["info", options.output]
    certified = "no contact on the whole path" if result.certified else "NO: contact is not ruled out everywhere"
    if result.certified and result.last.radius and start.radius:  # it gives way, or grows where strands are separated
        least = map(min, zip(start.radius, result.last.radius, strict=True))
        radii = ", ".join(f"{radius:.4g}" for radius in dict.fromkeys(least))
        certified = f"a rope of radius {radii} on the whole path"
    rows = [
        ("reason", told),
        *(_energies(result, start.curve, options.tolerance) if falls else ()),
        ("certified", certified),
        *(("note", note) for note in notes),
        ("wrote", [quoted(path) for path in written]),
        ("next", [command(*following)] if following else ""),
    ]
    head = f"{mark} {result.status.value.replace('_', ' ')}", " · ".join(took)
    return report(head, rows, sys.stderr, colour)


def _energies(result: Result, first: Curve, tolerance: float) -> Iterator[tuple[str, str]]:
    """From what to what the energy went, and the objective where it differs; and how near to rest the curve is."""
    start, end, about = moebius_energy(centred(first))[0], result.final_energy, ""
    tiny = 1e-9 * max(abs(start), 1.0)  # below it is rounding
    if result.mesh_error is None:
        share = max(1e-5, result.final_energy_error)
    else:
        share = min(1.0, result.mesh_error / abs(end))
        about = f" (mesh error about {100.0 * share:.1g} %)" if share > 1e-6 else " (mesh error below 0.0001 %)"
        about = about if share < 0.5 else " (the mesh is too coarse to tell the energy)"

    def told(*ends: float) -> str:
        return " → ".join(digits(value, max(share, 1e-6) * abs(value)) if abs(value) > tiny else "0" for value in ends)

    if result.final_energy_error:
        about = f" (± {100.0 * result.final_energy_error:.1g} %, from a sample)"
    yield "energy", told(start, end) + about
    first_and_last = result.energies[0], result.energies[-1]
    pairs = zip(first_and_last, (start, end), strict=True)
    # 0.01: difference of the objective from the energy, relative to it, from which both are told
    if any(abs(one - other) > 0.01 * abs(other) + tiny for one, other in pairs):
        yield "objective", f"{told(*first_and_last)}, which is minimised: the energy with its barrier and other terms"
    bound = gradient_bound(RelaxOptions(tolerance=tolerance), result.curve.mesh, result.energies[-1])
    yield "gradient", f"{power(result.last.gradient_norm)} (limit {power(bound)})"
