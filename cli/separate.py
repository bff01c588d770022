"""``mobius-flow separate``: curves that are nearer than their radii become ropes that keep clear."""

import argparse
from dataclasses import asdict

from ..core.base import OptionError
from ..core.ropes import AXES, Separated, SeparateOptions, separating
from . import curves
from . import options as relax_options
from .relax import add_outputs, provenance, read_task, run_to_end, write_results

_EPILOG = """\
examples:
  mobius-flow separate cables.obj clear.obj --radius 0.05 --report report.json --trajectory path.npz
  mobius-flow separate drawing.txt clear.txt --radius 0.5 --over z
  mobius-flow separate hair.obj clear.obj --radius 0.02 --lengths keep --free-ends --pin 1,21,41

Curves are moved as little as their radii allow. Where centre lines meet, the later component goes over the earlier one,
and the report says so, with the place; from there on every motion is proved. The ends of open curves are held.

exit status:
  0    all ropes keep clear
  1    there is less room, or lengths cannot be kept; one line says where, and what was reached is written
  2    bad input or bad options, or an output that cannot be written; one line says what and where
  130  interrupted by Ctrl-C, SIGTERM or SIGHUP; what was reached is written
"""


def add_separate(parser: argparse.ArgumentParser) -> None:
    parser.description, parser.epilog = "Make ropes of curves that run through each other.", _EPILOG
    curves.add_input(parser, "polygons, closed or open")
    text = "radius of the ropes, one or one for each component with commas between"
    parser.add_argument("--radius", metavar="R,R,…", required=True, help=text)
    text = f"axis on whose side the later of two curves that meet goes over: {', '.join(AXES)}, such as --over=-z "
    text += "(default: the direction in which they extend least there)"
    parser.add_argument("--over", metavar="AXIS", help=text)
    text = "whether edges may change their lengths: free or keep (default: free)"
    parser.add_argument("--lengths", metavar="L", default="free", help=text)
    parser.add_argument(
        "--free-ends", action="store_true", help="hold the ends of open curves only where they are pins"
    )
    text = "stop after this many seconds of computing; what was reached so far is kept (default: no limit)"
    parser.add_argument("--time-limit", metavar="SECONDS", type=float, help=text)
    add_outputs(parser)
    relax_options.add_task(parser)
    parser.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    try:
        radius = tuple(map(float, options.radius.split(",")))
    except ValueError:
        raise OptionError(f"radius is {options.radius!r:.40}; give a number such as 0.1, or several: 0.1,0.2") from None
    wanted = SeparateOptions(
        radius=radius,
        over=options.over,
        lengths=options.lengths,
        free_ends=options.free_ends,
        time_limit=options.time_limit,
    )
    file, task = read_task(options)
    with curves.refusals(file):
        result, iterates = run_to_end(separating(task, wanted), task, options)
    origin = provenance(asdict(wanted), task, file)
    if isinstance(told := result.outcome, Separated):
        origin |= {"share": told.share, "moved": told.moved, "crossings": list(map(asdict, told.crossings))}
    return write_results(options, result, iterates, origin)
