"""``mobius-flow morph`` and ``same``: a proved motion from one curve to another, and whether there is any."""

import argparse
import sys

from ..core import CurveError, Iterate, RelaxOptions, Status, Task, read_obstacle
from ..core.base import counted
from ..core.driver import finish
from ..core.driver.morph import DifferentError, NoMotionError, compare, morphing, moving
from ..core.io import FORMATS, CurveFile
from . import curves
from . import options as relax_options
from .places import check_holds, check_output, check_places
from .relax import add_outputs, places, provenance, run_to_end, write_results
from .signals import INTERRUPTED
from .terminal import emit, one_line

NAMES = ("A", "B")  # of the curves, on the command line and in sentences
_ONE_CURVE = ("balance", "grow", "mesh", "edge_lengths", "stability", "escape_saddles")  # not for two curves
_EPILOG = """\
examples:
  mobius-flow morph a.txt b.txt film.mp4
  mobius-flow morph a.txt b.txt b.obj --trajectory proof.npz
  mobius-flow verify proof.npz
  mobius-flow morph a.txt b.txt b.obj --hops 20

Both curves are relaxed; where their shapes meet, the way of B is run backwards. The first frame of the trajectory is A
and the last is B, bit for bit, so that it proves that both are the same knot or link. If the outcome says that
components have another order or direction in the end, so have the vertices of the last frame. Open components are held
at their ends, which must be in the same places in A and B.

exit status:
  0    a motion was found, and proved free of contact
  1    there is none, as invariants show, or none was found: one line says which, and nothing is written; or the time
       was up, and what was reached is written
  2    bad input or bad options, or an output that cannot be written; one line says what and where
  130  interrupted by Ctrl-C, SIGTERM or SIGHUP; what was reached is written
"""
_EPILOG_OF_SAME = """\
examples:
  mobius-flow same a.txt b.txt
  mobius-flow same a.txt b.txt --hops 20

Invariants decide where they can; otherwise a motion is looked for, as mobius-flow morph does. Directions and the order
of components do not matter; mirror images do.

exit status:
  0    the same, with proof: a common type was identified, or a motion leads from one to the other
  1    different, with the invariant that says so, or not known
  2    bad input or bad options
  130  interrupted
"""


def add_morph(parser: argparse.ArgumentParser) -> None:
    parser.description, parser.epilog = "Find a motion from one curve to another, free of contact with proof.", _EPILOG
    add_pair(parser)
    add_outputs(parser)
    parser.set_defaults(run=_run)


def add_pair(parser: argparse.ArgumentParser) -> None:
    """Add two curves, and how they are relaxed."""
    for name in NAMES:
        parser.add_argument(name.lower(), metavar=name, help=f"polygons, closed or open: {', '.join(FORMATS)}")
    curves.add_format(parser)
    relax_options.add_to(parser, without=_ONE_CURVE)
    text = "OBJ file of triangles or polylines that both curves and the motion avoid; may be given several times"
    parser.add_argument("--avoid", metavar="MESH.obj", action="append", default=[], help=text)


def read_pair(options: argparse.Namespace, wanted: RelaxOptions) -> tuple[tuple[CurveFile, Task], ...]:
    """Both curves with their files, and what they avoid; raises CurveFileError if one cannot be relaxed."""
    if options.a == options.b == curves.STREAM:
        raise CurveError("standard input can be read once only; give - once")
    files = [curves.read(path, options.format) for path in (options.a, options.b)]
    obstacles = tuple(map(read_obstacle, options.avoid))
    pairs = tuple((file, Task(curve=file.curve, obstacles=obstacles)) for file in files)
    for file, task in pairs:
        with curves.refusals(file):
            task.refined(wanted.vertices)
    return pairs


def _run(options: argparse.Namespace) -> int:
    check_output(options.output, options.format, options.look, options.loop or options.constant_radius)
    wanted = relax_options.from_arguments(options)
    check_places(relax_options.inputs(options, A=options.a, B=options.b), places(options))
    (file, task), (other, goal) = read_pair(options, wanted)
    check_holds(options.output, options.format, file.curve)
    origin = provenance(vars(wanted.resolved), task, file)
    origin["to"] = {"name": str(other.source.path), "sha256": other.source.sha256}
    try:
        result, iterates = run_to_end(morphing((task, goal), wanted, NAMES), task, options, wanted)
    except NoMotionError as error:
        print(one_line(f"mobius-flow: {error}"), file=sys.stderr)
        return 1
    status = write_results(options, result, iterates, origin)
    return 1 if result.status is Status.TIME_LIMIT else status


def add_same(parser: argparse.ArgumentParser) -> None:
    parser.description, parser.epilog = "Tell whether two curves are the same knot or link.", _EPILOG_OF_SAME
    add_pair(parser)
    parser.set_defaults(run=_run_same)


def _run_same(options: argparse.Namespace) -> int:
    wanted = relax_options.from_arguments(options)
    tasks = [task for _, task in read_pair(options, wanted)]
    iterates = moving(tasks, wanted, NAMES)
    way: list[Iterate] = []
    try:
        agreed = compare([each.curve for each in tasks], NAMES)
        if agreed and not options.avoid:
            emit(f"same: {agreed}")
            return 0
        result = finish(iterates, tasks[0], way.append)
    except NoMotionError as error:
        emit(f"{'different' if isinstance(error, DifferentError) else 'not known'}: {error}")
        return 1
    if not (result.outcome.converged and result.certified):
        emit(f"not known: {result.message}")
        return INTERRUPTED if result.status is Status.INTERRUPTED else 1
    legs = counted(sum(len(iterate.path) for iterate in way), "leg")
    emit(f"same: a motion of {legs}, proved free of contact, leads from one to the other")
    return 0
