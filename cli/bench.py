"""``mobius-flow bench``: relax hard curves from the project's own generators and tell their types."""

import argparse
from typing import TYPE_CHECKING

from ..core.bench import SETS, Row, bench
from ..core.energies import MoebiusEnergy
from ..core.errors import OptionError
from . import options as relax_options

CIRCLE = 4.02  # energy below which an unknot counts as a circle

if TYPE_CHECKING:
    Subparsers = argparse._SubParsersAction[argparse.ArgumentParser]


def add_to(subparsers: "Subparsers") -> None:
    """Add the subcommand."""
    parser = subparsers.add_parser("bench", help="relax a set of hard curves", description=__doc__)
    parser.add_argument("set", choices=list(SETS), help="hard curves of all kinds, or the table to ten crossings")
    parser.add_argument("--only", metavar="A,B,…", help=f"names, comma separated, such as {', '.join(SETS['knots'])}")
    relax_options.add_to(parser)
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print one row per curve; exit status 1 if a type changed, an unknot is no circle, or a proof is missing."""
    curves = SETS[options.set]
    names = list(curves) if options.only is None else [name.strip() for name in options.only.split(",")]
    for name in names:
        if name not in curves:
            raise OptionError(f"curve {name!r} is unknown; choose some of {', '.join(curves)}")
    print(f"{'curve':18} {'vertices':>11} {'type':>8} {'energy':>12} {'steps':>6} {'seconds':>8}  certified  status")
    good = True
    for row in bench({name: curves[name] for name in names}, relax_options.from_arguments(options)):
        print(_line(row), flush=True)
        round_circle = not row.name.startswith("unknot") or MoebiusEnergy().value(row.result.curve) < CIRCLE
        good &= row.same_type and row.result.certified and round_circle
    return 0 if good else 1


def _kind(row: Row) -> str:
    if not row.same_type:
        return "CHANGED"
    is_knot = len(row.result.curve.mesh.component_sizes) == 1
    return "unknot" if row.trivial and is_knot else "kept"


def _line(row: Row) -> str:
    result = row.result
    counts = f"{row.vertices_given} → {len(result.curve)}"
    certified = "yes" if result.certified else "NO"
    return (
        f"{row.name:18} {counts:>11} {_kind(row):>8} {result.energies[-1]:12.6f} {len(result.energies) - 1:6d} "
        f"{result.seconds:8.1f}  {certified:9}  {result.status.value}"
    )
