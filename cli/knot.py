"""``mobius-flow knot``: write a named knot as a curve file."""

import argparse
from typing import TYPE_CHECKING

from ..core import write_curve
from ..core.knots import knot

if TYPE_CHECKING:
    Subparsers = argparse._SubParsersAction[argparse.ArgumentParser]


def add_to(subparsers: "Subparsers") -> None:
    """Add the subcommand."""
    parser = subparsers.add_parser("knot", help="write a named knot", description=__doc__)
    parser.add_argument("name", metavar="NAME", help='such as 3_1, goeritz, hopf, "T(3,5)" or "braid(1,-2,1,-2)"')
    parser.add_argument("output", metavar="OUT", help="curve: .txt/.xyz, .obj, .vect or .json")
    parser.add_argument("--vertices", type=int, metavar="N", help="number of vertices")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Make the knot and write it."""
    write_curve(options.output, knot(options.name, vertices=options.vertices))
    return 0
