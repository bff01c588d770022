"""``mobius-flow energy``: the energy of a curve."""

import argparse
import json
from typing import TYPE_CHECKING

from ..core import read_curve
from ..core.energies import ENERGIES
from ..core.measure import measure

if TYPE_CHECKING:
    Subparsers = argparse._SubParsersAction[argparse.ArgumentParser]


def add_to(subparsers: "Subparsers") -> None:
    """Add the subcommand."""
    parser = subparsers.add_parser("energy", help="print the energy of a curve", description=__doc__)
    parser.add_argument("input", metavar="IN", help="curve: .txt/.xyz, .obj, .vect or .json")
    parser.add_argument("--energy", default="moebius", metavar="NAME", help=f"one of {', '.join(ENERGIES)}")
    parser.add_argument("--json", action="store_true", help="print JSON")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the energy."""
    value = measure(read_curve(options.input), options.energy)
    print(json.dumps({"name": options.energy, "energy": value}) if options.json else repr(value))
    return 0
