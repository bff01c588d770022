"""``mobius-flow relax``: a tangled curve in, a relaxed one out."""

import argparse
import json
import sys
from collections.abc import Callable
from typing import TYPE_CHECKING

from ..core import Curve, Iterate, RelaxOptions, Result, Status, Trajectory, minimize, read_curve
from ..core.errors import MobiusFlowError, OptionError
from ..core.files import atomic_write
from . import options as relax_options
from .outputs import OUTPUTS, Output, check_place, output_for
from .progress import Progress

if TYPE_CHECKING:
    Subparsers = argparse._SubParsersAction[argparse.ArgumentParser]

EXIT_STATUS = {Status.CONVERGED: 0, Status.ITERATION_LIMIT: 0, Status.STALLED: 1, Status.INTERRUPTED: 130}


def add_to(subparsers: "Subparsers") -> None:
    """Add the subcommand."""
    parser = subparsers.add_parser("relax", help="relax a curve", description=__doc__)
    parser.add_argument("input", metavar="IN", help="closed polygons: .txt/.xyz, .obj, .vect or .json")
    parser.add_argument("output", metavar="OUT", help=f"what to write, by suffix: {', '.join(OUTPUTS)}")
    parser.add_argument("--report", metavar="R.json", help="write what happened as JSON")
    parser.add_argument("--trajectory", metavar="T.npz", help="write the certified path, for mobius-flow verify")
    parser.add_argument("--quiet", action="store_true", help="print nothing but errors")
    relax_options.add_to(parser)
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Relax, write everything asked for, and return the exit status."""
    output = output_for(options.output)
    for extra in (options.report, options.trajectory):
        if extra is not None:
            check_place(extra)
    wanted = relax_options.from_arguments(options)
    if (wanted.adaptive or wanted.resolve) and output.needs_iterates:
        raise OptionError(
            f"{options.output}: keyframes need a fixed mesh; leave --adaptive and --resolve out, or write a curve file"
        )
    curve = read_curve(options.input)
    result, iterates, trajectory = _relax(curve, wanted, output, options)
    failures = []
    if options.report is not None:
        failures += _failure(lambda: _write_report(options.report, result))
    if options.trajectory is not None:
        failures += _failure(lambda: trajectory.save(options.trajectory))
    # last, since a film takes a minute, in which it may be interrupted
    shown = not options.quiet and sys.stderr.isatty()
    failures += _failure(lambda: output.write(options.output, result, iterates, shown))
    if failures:
        raise MobiusFlowError("; ".join(failures))
    if not options.quiet:
        print(_summary(result), file=sys.stderr)
    return EXIT_STATUS[result.status]


def _failure(write: Callable[[], None]) -> list[str]:
    """Write something, and return why that failed: the other outputs are written all the same."""
    try:
        write()
    except MobiusFlowError as error:
        return [str(error)]
    return []


def _relax(
    curve: Curve, wanted: RelaxOptions, output: Output, options: argparse.Namespace
) -> tuple[Result, list[Iterate], Trajectory]:
    iterates: list[Iterate] = []
    recorded = output.needs_iterates or options.trajectory is not None
    with Progress(wanted, shown=not options.quiet and sys.stderr.isatty()) as progress:

        def on_iterate(iterate: Iterate) -> None:
            if recorded:
                iterates.append(iterate)
            progress.update(iterate)

        result = minimize(curve, wanted, on_iterate)
    if recorded and not (iterates and iterates[-1].curve is result.curve):
        iterates.append(result.last)  # the interrupt came before it was recorded
    trajectory = Trajectory()
    for iterate in iterates:
        trajectory.add(iterate)
    return result, iterates, trajectory


def _write_report(path: str, result: Result) -> None:
    try:
        with atomic_write(path) as temporary:
            temporary.write_text(json.dumps(result.report(), indent=1) + "\n", encoding="utf-8")
    except OSError as error:
        raise MobiusFlowError(f"{path}: cannot be written: {error.strerror or error}") from error


def _summary(result: Result) -> str:
    certified = "certified free of contact" if result.certified else "NOT certified"
    return (
        f"{result.message}; energy {result.energies[0]:.6g} → {result.energies[-1]:.9g} in "
        f"{len(result.energies) - 1} iterations, {result.seconds:.1f} s, {certified}"
    )
