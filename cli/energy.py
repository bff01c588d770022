"""``mobius-flow energy``: the energy of a curve."""

import argparse
import json
from typing import TYPE_CHECKING

from ..core import read_curve
from ..core.collision import check_embedded
from ..core.energies import ENERGIES
from ..core.errors import OptionError
from ..core.units import check_units

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
    if options.energy not in ENERGIES:
        raise OptionError(f"energy {options.energy!r} is unknown; choose one of {', '.join(ENERGIES)}")
    curve = read_curve(options.input)
    check_units(curve)
    check_embedded(curve)
    value = ENERGIES[options.energy].value(curve)
    print(json.dumps({"name": options.energy, "energy": value}) if options.json else repr(value))
    return 0
