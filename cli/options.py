"""The options of a relaxation, shared by the subcommands that run one."""

import argparse
from collections.abc import Iterable
from dataclasses import fields

from ..core import METHODS, RelaxOptions
from ..core.energies import ENERGIES
from ..core.metrics import METRICS
from ..core.options import EDGE_LENGTHS


def add_to(parser: argparse.ArgumentParser, *, method: bool = True) -> None:
    """Add the options to a parser; ``method`` is left out where several are run."""
    defaults = RelaxOptions()
    group = parser.add_argument_group("relaxation")
    if method:
        group.add_argument("--method", default=defaults.method, metavar="M", help=_choice(METHODS, defaults.method))
    group.add_argument(
        "--max-iterations", type=int, default=defaults.max_iterations, metavar="K", help="(default: %(default)s)"
    )
    group.add_argument(
        "--tolerance",
        type=float,
        default=defaults.tolerance,
        metavar="T",
        help="stop at |projected gradient| ≤ T √E in the method's metric (default: %(default)s)",
    )
    group.add_argument("--vertices", type=int, metavar="N", help="refine to N vertices (default: by strand distance)")
    group.add_argument("--energy", default=defaults.energy, metavar="NAME", help=_choice(ENERGIES, defaults.energy))
    group.add_argument("--metric", metavar="NAME", help=_choice(METRICS, "the method's own"))
    group.add_argument(
        "--quadrature-points",
        type=int,
        metavar="k",
        help="Gauss points per edge of the metric J_C (default: the energy's)",
    )
    group.add_argument("--penalty", type=float, metavar="α", help="weight of length errors in the penalty methods")
    group.add_argument(
        "--edge-lengths", default=defaults.edge_lengths, metavar="L", help=_choice(EDGE_LENGTHS, defaults.edge_lengths)
    )
    group.add_argument("--adaptive", action="store_true", help="split and collapse edges during the run")
    group.add_argument(
        "--resolve",
        action="store_true",
        help="go on with more vertices while strands end nearer than the mesh resolves",
    )
    group.add_argument("--stability", action="store_true", help="tell whether a converged curve is a minimum")
    group.add_argument("--escape-saddles", action="store_true", help="and go on downhill from a saddle")


def from_arguments(arguments: argparse.Namespace) -> RelaxOptions:
    """The options; raises OptionError if one is out of range."""
    given = vars(arguments)
    return RelaxOptions(**{field.name: given[field.name] for field in fields(RelaxOptions) if field.name in given})


def _choice(names: Iterable[str], default: str) -> str:
    return f"one of {', '.join(names)} (default: {default})"
