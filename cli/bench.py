"""``mobius-flow bench``: relax hard curves from the project's own generators and tell their types, or measure speed."""

import argparse

from ..core.bench import SETS, Row, bench
from ..core.errors import OptionError, choice
from . import options as relax_options
from . import speed
from .streams import emit

MODES = [*SETS, "speed"]
CIRCLE = 4.02  # energy below which an unknot counts as a circle
_EPILOG = """\
examples:
  mobius-flow bench knots --only unknot-lattice-40,8_19
  mobius-flow bench speed --sizes 200,1000,5000 --json

The column "energy" is the Möbius energy of the result, as mobius-flow energy prints it.

"speed" takes steps on a bent trefoil and prints milliseconds of processor time: "lists" of near pairs and of pairs of
clusters; "energy"; "derivative", which includes the energy; "metric", building J; "gradient", factorising or
preconditioning the saddle-point system and solving it; "retract", the way back to the constraints; "proof", collision
detection along the step; and "iteration", all that a step takes on average.

exit status:
  0    every type was kept, every unknot became a circle, every proof is there; the speed was measured
  1    not so; the row says what
  2    bad options
  130  interrupted
"""


def add_to(parser: argparse.ArgumentParser) -> None:
    """Describe the subcommand."""
    parser.description, parser.epilog = (
        "Relax hard curves and compare their knot types before and after, or measure what a step costs.",
        _EPILOG,
    )
    parser.add_argument(
        "set",
        metavar=f"{{{','.join(MODES)}}}",
        choices=MODES,
        help="hard curves of all kinds, the table to ten crossings, or seconds a step",
    )
    parser.add_argument("--only", metavar="A,B,…", help=f"names, comma separated, such as {', '.join(SETS['knots'])}")
    speed.add_to(parser)
    relax_options.add_to(parser)


def run(options: argparse.Namespace) -> int:
    """Print a row per curve or size; exit status 1 if a type changed, an unknot is no circle, or a proof is missing."""
    if options.set == "speed":
        if options.only is not None:
            raise OptionError("--only names curves, and bench speed has one in many sizes; give --sizes")
        return speed.run(options)
    if options.sizes is not None or options.json:
        raise OptionError(f"--sizes and --json are for bench speed; leave them out of bench {options.set}")
    return _relax(options)


def _relax(options: argparse.Namespace) -> int:
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
