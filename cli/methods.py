"""``mobius-flow methods``: the descent methods, one per line."""

import argparse

from ..core.descent import METHODS
from .streams import emit


def add_to(parser: argparse.ArgumentParser) -> None:
    """Describe the subcommand."""
    parser.description = "List the descent methods: name, a tab, what it is; those for comparison come last."
    parser.epilog = "exit status: 0"


def run(options: argparse.Namespace) -> int:
    """Print name, a tab, and what it is."""
    emit("\n".join(f"{name}\t{method.sentence}" for name, method in METHODS.items()))
    return 0
