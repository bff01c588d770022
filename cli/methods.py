"""``mobius-flow methods``: the descent methods, one per line."""

import argparse
from typing import TYPE_CHECKING

from ..core.descent import METHODS

if TYPE_CHECKING:
    Subparsers = argparse._SubParsersAction[argparse.ArgumentParser]


def add_to(subparsers: "Subparsers") -> None:
    """Add the subcommand."""
    parser = subparsers.add_parser("methods", help="list the descent methods", description=__doc__)
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print name, a tab, and what it is."""
    for name, method in METHODS.items():
        print(f"{name}\t{method.description}")
    return 0
