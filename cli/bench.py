"""``mobius-flow bench``: relax hard curves from the project's own generators and tell their types."""

import argparse

from ..core.bench import SETS, Row, bench
from ..core.errors import OptionError, choice
from . import options as relax_options
from .streams import emit

CIRCLE = 4.02  # energy below which an unknot counts as a circle
_EPILOG = """\
example:
  mobius-flow bench knots --only unknot-lattice-40,8_19

The column "energy" is the Möbius energy of the result, as mobius-flow energy prints it.

exit status:
  0    every type was kept, every unknot became a circle, every proof is there
  1    not so; the row says what
  2    bad options
  130  interrupted
"""


def add_to(parser: argparse.ArgumentParser) -> None:
    """Describe the subcommand."""
    parser.description, parser.epilog = "Relax hard curves and compare their knot types before and after.", _EPILOG
    parser.add_argument(
        "set",
        metavar=f"{{{','.join(SETS)}}}",
        choices=list(SETS),
        help="hard curves of all kinds, or the table to ten crossings",
    )
    parser.add_argument("--only", metavar="A,B,…", help=f"names, comma separated, such as {', '.join(SETS['knots'])}")
    relax_options.add_to(parser)


def run(options: argparse.Namespace) -> int:
    """Print one row per curve; exit status 1 if a type changed, an unknot is no circle, or a proof is missing."""
    curves = SETS[options.set]
    names = list(curves) if options.only is None else [name.strip() for name in options.only.split(",")]
    for name in names:
        if name not in curves:
            raise OptionError(f"curve {name!r} is unknown; {choice(name, curves)}")
    wanted = relax_options.from_arguments(options)
    width = max(map(len, ["curve", *names]))
    emit(
        f"{'curve':{width}} {'vertices':>11} {'type':>8} {'energy':>12} {'steps':>6} {'seconds':>8}  certified  status"
    )
    good = True
    for row in bench({name: curves[name] for name in names}, wanted):
        emit(_line(row, width))
        round_circle = not row.name.startswith("unknot") or row.result.final_energy < CIRCLE
        good &= row.same_type and row.result.certified and round_circle
    return 0 if good else 1


def _kind(row: Row) -> str:
    if not row.same_type:
        return "CHANGED"
    is_knot = len(row.result.curve.mesh.component_sizes) == 1
    return "unknot" if row.trivial and is_knot else "kept"


def _line(row: Row, width: int) -> str:
    result = row.result
    counts = f"{row.vertices_given} → {len(result.curve)}"
    certified = "yes" if result.certified else "NO"
    return (
        f"{row.name:{width}} {counts:>11} {_kind(row):>8} {result.final_energy:12.6f} {len(result.energies) - 1:6d} "
        f"{result.seconds:8.1f}  {certified:9}  {result.status.value}"
    )
