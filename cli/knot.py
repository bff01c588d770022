"""``mobius-flow knot``: write a named knot as a curve file."""

import argparse

from ..core.curve.io import FORMATS
from ..core.knots import knot
from . import curves
from .places import check_place

_EPILOG = """\
examples:
  mobius-flow knot 3_1 trefoil.txt
  mobius-flow knot "T(3,5)" - --format obj

exit status: 0, or 2 on bad input or bad options, or where OUT cannot be written
"""


def add_to(parser: argparse.ArgumentParser) -> None:
    """Describe the subcommand."""
    parser.description, parser.epilog = "Write a named knot as a curve.", _EPILOG
    parser.add_argument("name", metavar="NAME", help='such as 3_1, goeritz, hopf, "T(3,5)" or "braid(1,-2,1,-2)"')
    parser.add_argument("output", metavar="OUT", help=f"curve: {', '.join(FORMATS)}, or - for standard output")
    curves.add_format(parser)
    parser.add_argument("--vertices", type=int, metavar="N", help="number of vertices")


def run(options: argparse.Namespace) -> int:
    """Make the knot and write it."""
    curves.format_for(options.output, options.format)
    check_place(options.output)
    curves.write(options.output, knot(options.name, vertices=options.vertices), options.format)
    return 0
