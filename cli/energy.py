"""``mobius-flow energy``: the energy of a curve."""

import argparse
import json

from ..core import CurveError
from ..core.checks import check_known
from ..core.curve.io import FORMATS
from ..core.energies import ENERGIES
from ..core.measure import measure
from . import curves
from .streams import emit

_EPILOG = """\
examples:
  mobius-flow energy knot.txt
  mobius-flow knot figure-eight - | mobius-flow energy - --json

exit status: 0, or 2 on bad input or bad options
"""


def add_to(parser: argparse.ArgumentParser) -> None:
    """Describe the subcommand."""
    parser.description, parser.epilog = "Print the energy of a curve.", _EPILOG
    parser.add_argument("input", metavar="IN", help=f"curve: {', '.join(FORMATS)}, or - for standard input")
    curves.add_format(parser)
    parser.add_argument("--energy", default="moebius", metavar="NAME", help=f"one of {', '.join(ENERGIES)}")
    parser.add_argument("--json", action="store_true", help="print JSON")


def run(options: argparse.Namespace) -> int:
    """Print the energy."""
    check_known("energy", options.energy, ENERGIES)  # before a large file is read
    file = curves.read(options.input, options.format)
    with curves.refusals(file):
        if len(file.curve) > curves.MAX_VERTICES:
            raise CurveError(
                f"the curve has {len(file.curve)} vertices; energies are for at most {curves.MAX_VERTICES}"
            )
        value = measure(file.curve, options.energy)
    emit(json.dumps({"name": options.energy, "energy": value}) if options.json else repr(value))
    return 0
