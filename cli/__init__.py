"""The command line: one file per subcommand, each thin."""

from .main import main

__all__ = ["main"]
