"""The parser of the command line: subcommands are loaded on demand."""

import argparse
import sys
from collections.abc import Iterable, Sequence
from importlib import import_module
from typing import Any, NoReturn

from .. import __version__
from .streams import emit, one_line

COMMANDS = {
    "relax": "relax a curve",
    "batch": "relax many curves, on all cores or a cluster",
    "gallery": "show the results of a batch",
    "energy": "print the energy of a curve",
    "info": "identify the knot type of curves, and measure them",
    "verify": "check a trajectory for contact",
    "compare": "compare descent methods on a curve",
    "knot": "write a named knot",
    "methods": "list the descent methods",
}
BAD_OPTIONS = 2
_EPILOG = """\
examples:
  mobius-flow knot 8_19 knot.txt
  mobius-flow relax knot.txt relaxed.obj --report report.json --trajectory path.npz
  mobius-flow verify path.npz
  mobius-flow relax --help

exit status:
  0    it ran, to the end or to the given limit
  1    it failed: a run that is stuck, a trajectory that is rejected, too little memory
  2    bad input or bad options, or an output that cannot be written; one line says what and where
  130  interrupted by Ctrl-C, SIGTERM or SIGHUP; what was reached is written
"""


class Parser(argparse.ArgumentParser):
    """A parser whose errors are one line, and which takes no abbreviations: they break when options are added."""

    def __init__(self, **arguments: Any) -> None:
        super().__init__(allow_abbrev=False, formatter_class=argparse.RawDescriptionHelpFormatter, **arguments)
        self.register("type", int, _whole_number)
        self.register("type", float, _number)

    def error(self, message: str) -> NoReturn:
        """End with one line."""
        self.exit(BAD_OPTIONS, f"{self.prog}: {message} (see {self.prog} --help)")

    def parse_known_args(  # type: ignore[override]
        self, args: Sequence[str] | None = None, namespace: argparse.Namespace | None = None
    ) -> tuple[argparse.Namespace, list[str]]:
        """Parse, and refuse what isn't known."""
        found, unknown = super().parse_known_args(args, namespace)
        if unknown:
            self.error(self._unknown(unknown[0].partition("=")[0]))
        return found, unknown

    def _unknown(self, word: str) -> str:
        if not word.startswith("-"):
            return f"unexpected argument {word!r}"
        from ..core.errors import likeliest

        known = [option for option in self._option_string_actions if option.startswith("--")]
        return f"option {word} is unknown; {likeliest(word, known)}".rstrip("; ")

    def exit(self, status: int = 0, message: str | None = None) -> NoReturn:
        """End with an exit status, and one line on standard error."""
        if message and sys.stderr is not None:
            print(one_line(message), file=sys.stderr)
        raise SystemExit(status)

    def _print_message(self, message: str, file: Any = None) -> None:
        emit(message.rstrip("\n"))  # argparse's own does not notice that nothing could be written

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        if action.choices is not None and value not in action.choices:
            raise argparse.ArgumentError(action, f"{value!r} is unknown; {closest(value, action.choices)}")


class Command(Parser):
    """The parser of a subcommand, whose module has ``add_to(parser)`` and ``run(options)``."""

    def parse_known_args(  # type: ignore[override]
        self, args: Sequence[str] | None = None, namespace: argparse.Namespace | None = None
    ) -> tuple[argparse.Namespace, list[str]]:
        """Load the subcommand before its arguments are parsed."""
        module = import_module(f".{self.prog.rpartition(' ')[2]}", __package__)
        module.add_to(self)
        self.set_defaults(run=module.run)
        return super().parse_known_args(args, namespace)


def _whole_number(text: str) -> int:
    try:
        return int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r:.60} is not a whole number") from None


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r:.60} is not a number") from None


def closest(name: object, known: Iterable[Any]) -> str:
    """What can be chosen instead of an unknown name."""
    from ..core.errors import choice

    return choice(str(name), map(str, known))


def parse(arguments: Sequence[str] | None = None) -> argparse.Namespace:
    """Parse the command line; ``run`` of the result is the subcommand's function. Raises SystemExit."""
    top = Parser(
        prog="mobius-flow",
        description="Relax and untangle knotted curves by their Möbius energy, never through themselves.",
        epilog=_EPILOG,
    )
    top.add_argument("--version", action="version", version=f"mobius-flow {__version__}")
    subparsers = top.add_subparsers(dest="command", metavar="COMMAND", title="commands", parser_class=Command)
    for name, summary in COMMANDS.items():
        subparsers.add_parser(name, help=summary)
    found = top.parse_args(arguments)
    if found.command is None:
        top.print_help()
        top.exit(BAD_OPTIONS, "mobius-flow: name a command")
    return found
