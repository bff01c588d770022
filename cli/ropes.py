"""``mobius-flow separate`` and ``tighten``: ropes, made of curves that are too near, and as short as can be."""

import argparse
from dataclasses import asdict

from ..core.base import OptionError, write_file
from ..core.keys.figure import contact_map
from ..core.keys.paper import PAPERS
from ..core.ropes import AXES, Separated, SeparateOptions, Tightened, TightenOptions, separating, tightening
from . import curves
from . import options as relax_options
from .parser import further
from .places import Write, suffix_of
from .relax import add_outputs, provenance, read_task, run_to_end, write_results

_EPILOG_OF_SEPARATE = """\
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
_EPILOG_OF_TIGHTEN = """\
examples:
  mobius-flow tighten knot.txt tight.txt --report report.json --trajectory path.npz
  mobius-flow tighten knot.txt film.mp4 --constant-radius --look rope
  mobius-flow knot 7_7 - | mobius-flow tighten - tight.txt --starts 5 --vertices 1600

exit status:
  0    the rope is as short as it can be nearby, or the time was up
  1    forces are not in equilibrium: the shortest rope that was reached is written
  2    bad input or bad options, or an output that cannot be written; one line says what and where
  130  interrupted by Ctrl-C, SIGTERM or SIGHUP; what was reached is written
"""
_REPORT = """\
"energy" is the length over the rope's radius at every iterate, "ropelength" that over the thickness of the result.
"gap" and "residual" tell how near it is to equilibrium. "struts" are edges, counted from 0, that press on each other,
with their forces, relative to the tension.
"""


def add_separate(parser: argparse.ArgumentParser) -> None:
    parser.description, parser.epilog = "Make ropes of curves that run through each other.", _EPILOG_OF_SEPARATE
    curves.add_input(parser, "polygons, closed or open")
    text = "radius of the ropes, one or one for each component with commas between"
    parser.add_argument("--radius", metavar="R,R,…", required=True, help=text)
    text = f"axis on whose side the later of two curves that meet goes over: {', '.join(AXES)}, such as --over=-z "
    text += "(default: the direction in which they extend least there)"
    parser.add_argument("--over", metavar="AXIS", help=text)
    text = "whether edges may change their lengths: free or keep (default: free)"
    parser.add_argument("--lengths", metavar="L", default="free", help=text)
    text = "hold the ends of open curves only where they are pins"
    parser.add_argument("--free-ends", action="store_true", help=text)
    _add_the_rest(parser)
    relax_options.add_task(parser)
    parser.set_defaults(run=_separate)


def add_tighten(parser: argparse.ArgumentParser) -> None:
    parser.description = "Pull a knot or link tight: the shortest rope of its thickness."
    parser.epilog = _EPILOG_OF_TIGHTEN
    curves.add_input(parser, "polygons, closed or open")
    text = "vertices in the end, or up to twice as many (default: 800, and 400 of open ropes)"
    parser.add_argument("--vertices", metavar="N", type=int, help=text)
    text = "starts on few vertices, all but the first drawn anew; the best three go on to the end (default: 1)"
    parser.add_argument("--starts", metavar="K", type=int, default=1, help=text)
    parser.add_argument("--seed", metavar="S", type=int, default=0, help="seed of the drawings (default: 0)")
    text = "write a map of where strands press on each other: SVG, PDF or TikZ"
    parser.add_argument("--contacts", metavar="MAP.svg", help=text)
    _add_the_rest(parser)
    further(parser, "the report", _REPORT)
    parser.set_defaults(run=_tighten, pins=[], pin_tangents=False, avoid=[])


def _add_the_rest(parser: argparse.ArgumentParser) -> None:
    text = "stop after this many seconds of computing; what was reached so far is kept (default: no limit)"
    parser.add_argument("--time-limit", metavar="SECONDS", type=float, help=text)
    add_outputs(parser)


def _separate(options: argparse.Namespace) -> int:
    try:
        radius = tuple(map(float, options.radius.split(",")))
    except ValueError:
        raise OptionError(f"radius is {options.radius!r:.40}; give a number such as 0.1, or several: 0.1,0.2") from None
    named = {name: getattr(options, name) for name in ("over", "lengths", "free_ends", "time_limit")}
    wanted = SeparateOptions(radius=radius, **named)
    file, task = read_task(options)
    with curves.refusals(file):
        result, iterates = run_to_end(separating(task, wanted), task, options)
    origin = provenance(asdict(wanted), task, file)
    if isinstance(told := result.outcome, Separated):
        origin |= {"share": told.share, "moved": told.moved, "crossings": list(map(asdict, told.crossings))}
    return write_results(options, result, iterates, origin)


def _tighten(options: argparse.Namespace) -> int:
    wanted = TightenOptions(**{name: getattr(options, name) for name in ("vertices", "starts", "seed", "time_limit")})
    suffix = options.contacts and suffix_of(options.contacts, PAPERS, "drawings")
    file, task = read_task(options, **{"--contacts": options.contacts})
    with curves.refusals(file):
        result, iterates = run_to_end(tightening(task, wanted), task, options)
    origin, more = provenance(asdict(wanted), task, file), dict[str, Write]()
    if isinstance(told := result.outcome, Tightened):
        origin |= {"ropelength": told.ropelength, "gap": told.gap, "residual": told.residual, "struts": told.struts}
        if suffix:
            drawn = PAPERS[suffix](contact_map(result.curve, told.struts))
            more[options.contacts] = lambda path: write_file(path, drawn)
    return write_results(options, result, iterates, origin, more)
