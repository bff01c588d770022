"""``mobius-flow tighten``: knots and links are pulled tight."""

import argparse
from dataclasses import asdict
from pathlib import Path

from ..core import MobiusFlowError, RelaxOptions, Task
from ..core.base import wrong_suffix
from ..core.keys.contact_map import contact_map
from ..core.keys.paper import PAPERS
from ..core.ropes import Tightened, TightenOptions, tightening
from . import curves
from . import options as relax_options
from .parser import further
from .places import check_holds, check_output, check_places, writing
from .relax import EXIT_STATUS, add_outputs, places, run_to_end, write_results

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
    parser.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    """Tighten, write every requested output, and return the exit status."""
    check_output(options.output, options.format, options.look, options.loop or options.constant_radius)
    named = {name: getattr(options, name) for name in ("vertices", "starts", "seed", "time_limit")}
    wanted = TightenOptions(**named)
    mapped = None if options.contacts is None else Path(options.contacts)
    if mapped and mapped.suffix.lower() not in PAPERS:
        raise MobiusFlowError(f"{mapped}: {wrong_suffix(mapped, PAPERS, 'drawings')}")
    check_places({"IN": options.input}, places(options) | {"--contacts": options.contacts})
    file = curves.read(options.input, options.format)
    check_holds(options.output, options.format, file.curve)
    origin = relax_options.provenance(asdict(wanted), str(file.source.path), file.source.sha256)
    with curves.refusals(file):
        task = Task(curve=file.curve)
        result, iterates = run_to_end(tightening(task, wanted), task, RelaxOptions(), options)
    if isinstance(result.outcome, Tightened):
        told = result.outcome
        origin |= {"ropelength": told.ropelength, "gap": told.gap, "residual": told.residual, "struts": told.struts}
        if mapped:
            with writing(options.contacts) as temporary:
                temporary.write_bytes(PAPERS[mapped.suffix.lower()](contact_map(result.curve, told.struts)))
    write_results(options, result, iterates, origin)
    return EXIT_STATUS[result.status]
