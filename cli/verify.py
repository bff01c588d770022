"""``mobius-flow verify``: check a trajectory independently of the run that wrote it."""

import argparse
from typing import TYPE_CHECKING

from ..core.verify import verify

if TYPE_CHECKING:
    Subparsers = argparse._SubParsersAction[argparse.ArgumentParser]


def add_to(subparsers: "Subparsers") -> None:
    """Add the subcommand."""
    parser = subparsers.add_parser("verify", help="check a trajectory for contact", description=__doc__)
    parser.add_argument("trajectory", metavar="T.npz", help="as written by relax --trajectory")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the verdict; exit status 0 if the trajectory is free of contact, 1 if not."""
    verdict = verify(options.trajectory)
    print(verdict)
    return 0 if verdict.accepted else 1
