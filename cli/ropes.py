"""``mobius-flow separate`` and ``tighten``: ropes, made of curves that are too near, and as short as can be."""

import argparse
from dataclasses import asdict

from ..core.keys.paper import PAPERS
from ..core.ropes import SeparateOptions, TightenOptions, separating, tightening
from . import curves
from . import options as relax_options
from .parser import further
from .places import suffix_of
from .relax import add_outputs, carry_out

_EPILOG_OF_SEPARATE = """\
examples:
  mobius-flow separate cables.obj clear.obj --radius 0.05 --report report.json --trajectory path.npz
  mobius-flow separate drawing.txt clear.txt --radius 0.5 --over=-z
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
    relax_options.add_all(parser, SeparateOptions)
    add_outputs(parser)
    relax_options.add_task(parser)
    parser.set_defaults(run=_separate)


def add_tighten(parser: argparse.ArgumentParser) -> None:
    parser.description = "Pull a knot or link tight: the shortest rope of its thickness."
    parser.epilog = _EPILOG_OF_TIGHTEN
    curves.add_input(parser, "polygons, closed or open")
    relax_options.add_all(parser, TightenOptions)
    text = "write a map of where strands press on each other: SVG, PDF or TikZ"
    parser.add_argument("--contacts", metavar="MAP.svg", help=text)
    add_outputs(parser)
    further(parser, "the report", _REPORT)
    parser.set_defaults(run=_tighten, pins=[], pin_tangents=False, avoid=[])


def _separate(options: argparse.Namespace) -> int:
    wanted = relax_options.from_arguments(options, SeparateOptions)
    return carry_out(options, asdict(wanted), lambda task: separating(task, wanted))


def _tighten(options: argparse.Namespace) -> int:
    wanted = relax_options.from_arguments(options, TightenOptions)
    if options.contacts:
        suffix_of(options.contacts, PAPERS, "drawings")
    return carry_out(options, asdict(wanted), lambda task: tightening(task, wanted))
