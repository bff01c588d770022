"""``mobius-flow tighten``: knots and links are pulled tight."""

import argparse
from dataclasses import asdict

from ..core.base import write_file
from ..core.keys.contact_map import contact_map
from ..core.keys.paper import PAPERS
from ..core.ropes import Tightened, TightenOptions, tightening
from . import curves
from .parser import further
from .places import Write, suffix_of
from .relax import add_outputs, provenance, read_task, run_to_end, write_results

_EPILOG = """\
examples:
  mobius-flow tighten knot.txt tight.txt --report report.json --trajectory path.npz
  mobius-flow tighten knot.txt film.mp4 --constant-radius --look rope
  mobius-flow knot 7_7 - | mobius-flow tighten - tight.txt --starts 5 --vertices 800

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


def add_tighten(parser: argparse.ArgumentParser) -> None:
    parser.description, parser.epilog = "Pull a knot or link tight: the shortest rope of its thickness.", _EPILOG
    curves.add_input(parser, "polygons, closed or open")
    text = "vertices in the end, or up to twice as many (default: 400)"
    parser.add_argument("--vertices", metavar="N", type=int, default=400, help=text)
    text = "starts on few vertices, stirred at random but for the first; the best three go on to the end (default: 1)"
    parser.add_argument("--starts", metavar="K", type=int, default=1, help=text)
    parser.add_argument("--seed", metavar="S", type=int, default=0, help="seed of the random motions (default: 0)")
    text = "stop after this many seconds of computing; what was reached so far is kept (default: no limit)"
    parser.add_argument("--time-limit", metavar="SECONDS", type=float, help=text)
    text = "write a map of where strands press on each other: SVG, PDF or TikZ"
    parser.add_argument("--contacts", metavar="MAP.svg", help=text)
    add_outputs(parser)
    further(parser, "the report", _REPORT)
    parser.set_defaults(run=_run, pins=[], pin_tangents=False, avoid=[])


def _run(options: argparse.Namespace) -> int:
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
