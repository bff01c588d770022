"""The parser of the command line with all of its subcommands, which it loads one at a time otherwise."""

import argparse

from mobius_flow.cli import parser


def whole() -> argparse.ArgumentParser:
    """The parser that ``mobius-flow --help`` describes."""
    top = argparse.ArgumentParser(prog="mobius-flow", add_help=False)
    commands = top.add_subparsers(title="commands")
    for name, (_, summary) in parser.COMMANDS.items():
        added = commands.add_parser(name, help=summary, formatter_class=argparse.RawDescriptionHelpFormatter)
        parser.add_to(added, name)
    return top
