"""The parser of the command line: subcommands are loaded on demand."""

import argparse
import sys
from collections.abc import Callable, Sequence
from importlib import import_module
from typing import Any, NoReturn

from .. import __version__
from .streams import emit, one_line

COMMANDS = {  # the module of each, which has add_COMMAND(parser), and what it does
    "relax": ("relax", "relax a curve"),
    "morph": ("morph", "find a proved motion from one curve to another"),
    "same": ("morph", "tell whether two curves are the same knot or link"),
    "batch": ("batch", "relax many curves, on all cores or a cluster"),
    "atlas": ("atlas", "make pages and tables of the minima that batches found"),
    "gallery": ("gallery", "show the results of a batch"),
    "energy": ("info", "print the energy of a curve"),
    "info": ("info", "identify the knot type of curves, and measure them"),
    "verify": ("verify", "check a trajectory for contact"),
    "view": ("view", "show a curve or a motion in a browser, or make a solid of it"),
    "compare": ("compare", "compare descent methods on a curve"),
    "knot": ("knot", "write a named knot"),
    "methods": ("compare", "list the descent methods"),
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
        self.register("type", int, _read(int, "a whole number"))
        self.register("type", float, _read(float, "a number"))

    def error(self, message: str) -> NoReturn:
        self.exit(BAD_OPTIONS, f"{self.prog}: {message} (see {self.prog} --help)")

    def parse_known_args(  # type: ignore[override]
        self, args: Sequence[str] | None = None, namespace: argparse.Namespace | None = None
    ) -> tuple[argparse.Namespace, list[str]]:
        found, unknown = super().parse_known_args(args, namespace)
        word = unknown[0].partition("=")[0] if unknown else ""
        if word.startswith("-"):
            from ..core.errors import likeliest

            known = [option for option in self._option_string_actions if option.startswith("--")]
            self.error(f"option {word} is unknown; {likeliest(word, known)}".rstrip("; "))
        if unknown:
            self.error(f"unexpected argument {word!r}")
        return found, unknown

    def exit(self, status: int = 0, message: str | None = None) -> NoReturn:
        """End with an exit status, and one line on standard error."""
        if message and sys.stderr is not None:
            print(one_line(message), file=sys.stderr)
        raise SystemExit(status)

    def _print_message(self, message: str, file: Any = None) -> None:
        emit(message.rstrip("\n"))  # argparse's own does not notice that nothing could be written

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        if action.choices is not None and value not in action.choices:
            from ..core.errors import choice

            known = choice(str(value), map(str, action.choices))
            raise argparse.ArgumentError(action, f"{value!r} is unknown; {known}")


class Command(Parser):
    """The parser of a subcommand, which is loaded before its arguments are parsed."""

    def parse_known_args(  # type: ignore[override]
        self, args: Sequence[str] | None = None, namespace: argparse.Namespace | None = None
    ) -> tuple[argparse.Namespace, list[str]]:
        add_to(self, self.prog.rpartition(" ")[2])
        return super().parse_known_args(args, namespace)


def add_to(parser: argparse.ArgumentParser, name: str) -> None:
    """Describe a subcommand, and let ``run`` be the function that carries it out."""
    getattr(import_module(f".{COMMANDS[name][0]}", __package__), f"add_{name}")(parser)


def _read(kind: Callable[[str], Any], meaning: str) -> Callable[[str], Any]:
    def read(text: str) -> Any:
        try:
            return kind(text)
        except ValueError:
            raise argparse.ArgumentTypeError(f"{text!r:.60} is not {meaning}") from None

    return read


def parse(arguments: Sequence[str] | None = None) -> argparse.Namespace:
    """Parse the command line. Raises SystemExit."""
    top = Parser(
        prog="mobius-flow",
        description="Relax and untangle knotted curves by their Möbius energy, never through themselves.",
        epilog=_EPILOG,
    )
    top.add_argument("--version", action="version", version=f"mobius-flow {__version__}")
    subparsers = top.add_subparsers(dest="command", metavar="COMMAND", title="commands", parser_class=Command)
    for name, (_, summary) in COMMANDS.items():
        subparsers.add_parser(name, help=summary)
    found = top.parse_args(arguments)
    if found.command is None:
        top.print_help()
        top.exit(BAD_OPTIONS, "mobius-flow: name a command")
    return found
