"""The parser of the command line: subcommands are loaded on demand."""

import argparse
import logging
import sys
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from importlib import import_module
from importlib.metadata import EntryPoint, entry_points
from typing import Any, NoReturn

from .. import __version__
from .terminal import emit, sentence

COMMANDS = {  # the module of each, which has add_COMMAND(parser), and what it does; see also `joined`
    "relax": ("relax", "relax a curve"),
    "morph": ("morph", "find a proved motion from one curve to another"),
    "separate": ("ropes", "make ropes of curves that run through each other"),
    "same": ("morph", "tell whether two curves are the same knot or link"),
    "tighten": ("ropes", "pull a knot or link tight"),
    "energy": ("info", "print the energy of a curve"),
    "info": ("info", "identify the knot type of curves, and measure them"),
    "verify": ("verify", "check a trajectory for contact"),
    "audit": ("audit", "tell which chains of another program's trajectory passed through each other"),
    "view": ("pictures", "show a curve or a motion in a browser, or make a solid of it"),
    "draw": ("pictures", "draw diagrams of curves, codes and named knots"),
    "knot": ("knot", "write a named knot"),
}
SHELLS = ("bash", "zsh", "fish")
Group = argparse._ArgumentGroup
_EPILOG = """\
examples:
  mobius-flow knot 8_19 knot.txt
  mobius-flow relax knot.txt relaxed.obj --report report.json --trajectory path.npz
  mobius-flow verify path.npz
  mobius-flow relax --help
  mobius-flow --print-completion bash > ~/.local/share/bash-completion/completions/mobius-flow

exit status:
  0    it ran, to the end or to the given limit
  1    it failed: a run that is stuck, a trajectory that is rejected, too little memory
  2    bad input or bad options, or an output that cannot be written; one line says what and where
  130  interrupted by Ctrl-C, SIGTERM or SIGHUP; what was reached is written
"""


class Parser(argparse.ArgumentParser):
    """A parser whose errors are one line, and which takes no abbreviations: they break when options are added."""

    def __init__(self, **arguments: Any) -> None:
        self.left_out: list[Group] = []
        super().__init__(allow_abbrev=False, formatter_class=argparse.RawDescriptionHelpFormatter, **arguments)
        self.register("type", int, _read(int, "a whole number"))
        self.register("type", float, _read(float, "a number"))

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {message} (see {self.prog} --help)")

    def check_known(self, unknown: Sequence[str]) -> None:
        """End with a sentence about the first word that means nothing, if there is one."""
        word = unknown[0].partition("=")[0] if unknown else ""
        if word.startswith("-"):
            from ..core.base.errors import likeliest

            known = [option for option in self._option_string_actions if option.startswith("--")]
            self.error(f"option {word} is unknown; {likeliest(word, known)}".rstrip("; "))
        if unknown:
            self.error(f"unexpected argument {word!r}")

    def format_help(self) -> str:
        """The help, without the groups that are left out, and with no more than the arguments in its usage."""
        groups = self._action_groups
        if self.left_out or "--help-all" in self._option_string_actions:
            needed = [action for action in self._actions if action.required]
            words = (
                " ".join([*action.option_strings[:1], f"{action.metavar}{' …' * (action.nargs == '+')}"])
                for action in needed
            )
            self.usage = f"%(prog)s [options] {' '.join(words)}"
        self._action_groups = [group for group in groups if group not in self.left_out]
        try:
            return super().format_help()
        finally:
            self._action_groups = groups

    def exit(self, status: int = 0, message: str | None = None) -> NoReturn:
        """End with an exit status, and one line on standard error."""
        if message and sys.stderr is not None:
            print(sentence(message, sys.stderr), file=sys.stderr)
        raise SystemExit(status)

    def _print_message(self, message: str, file: Any = None) -> None:
        emit(message.rstrip("\n"))  # argparse's own does not notice that nothing could be written

    def _get_values(self, action: argparse.Action, arg_strings: list[str]) -> Any:
        if action.option_strings and action.nargs is None and arg_strings == ["--"]:  # which would become an empty list
            raise argparse.ArgumentError(action, "-- is no value")
        return super()._get_values(action, arg_strings)

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        if action.choices is not None and value not in action.choices:
            from ..core.base.errors import choice

            known = choice(str(value), map(str, action.choices))
            raise argparse.ArgumentError(action, f"{value!r} is unknown; {known}")


def further(parser: argparse.ArgumentParser, title: str, text: str | None = None) -> Group:
    """A group of options, or a text, for ``--help-all`` alone: what few need would hide what most look for."""
    group = parser.add_argument_group(title, text)
    if isinstance(parser, Parser):
        if not parser.left_out:
            parser.add_argument("--help-all", action=_HelpAll, nargs=0, help="show all options, and exit")
        parser.left_out.append(group)
    return group


class _HelpAll(argparse.Action):
    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> None:
        if isinstance(parser, Parser):
            parser.left_out.clear()
        parser.print_help()
        parser.exit()


class _PrintCompletion(argparse.Action):
    """Print what completes commands, options, names and files in a shell, by shtab."""

    def __call__(self, parser: argparse.ArgumentParser, _: Any, shell: Any, option: str | None = None) -> None:
        try:
            import shtab
        except ImportError:
            parser.error('completion needs shtab: pip install shtab (the extra "cli")')
        from ..core import RelaxOptions
        from ..core.base.arguments import declared

        names = {each.name: list(each.choices) for each in declared(RelaxOptions) if each.choices and not each.objects}
        (commands,) = (each for each in parser._actions if isinstance(each, argparse._SubParsersAction))
        for name, command in commands.choices.items():
            add_to(command, name)
            for action in command._actions:
                action.choices = names.get(action.dest, action.choices)
                if action.choices is None and action.nargs != 0 and action.type not in (int, float):
                    kind = shtab.DIRECTORY if action.metavar in ("DIR", "RESULTS") else shtab.FILE
                    action.complete = kind
        emit(shtab.complete(parser, shell))
        parser.exit()


@cache
def joined() -> Mapping[str, EntryPoint]:
    """The subcommands that installed packages add, by entry points in ``mobius_flow.commands``.

    Each is a function like ``add_relax``; the first line of its docstring tells what it does.
    """
    found: dict[str, EntryPoint] = {}
    for entry in entry_points(group="mobius_flow.commands"):
        if entry.name in COMMANDS or entry.name in found:
            _leave_out(entry, ValueError("there is such a command already"))
        else:
            found[entry.name] = entry
    return found


def _leave_out(entry: EntryPoint, error: Exception) -> None:
    from ..core.base.plugins import leave_out

    leave_out(entry, error)


def add_to(parser: argparse.ArgumentParser, name: str) -> None:
    """Describe a subcommand, and let ``run`` be the function that carries it out."""
    if name in COMMANDS:
        getattr(import_module(f".{COMMANDS[name][0]}", __package__), f"add_{name}")(parser)
        return
    entry = joined()[name]
    try:
        entry.load()(parser)
        if not callable(parser.get_default("run")):
            raise TypeError("it sets no function to run")
    except Exception as error:  # whatever another package's code may raise
        if entry.value.startswith("mobius_flow.lab."):
            raise
        _leave_out(entry, error)
        parser.exit(1)


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
    text = f"print what completes commands in a shell, and exit: {', '.join(SHELLS)}"
    top.add_argument("--print-completion", action=_PrintCompletion, metavar="SHELL", choices=SHELLS, help=text)
    subparsers = top.add_subparsers(dest="command", metavar="COMMAND", title="commands")
    for name, (_, summary) in COMMANDS.items():
        subparsers.add_parser(name, help=summary)
    words = sys.argv[1:] if arguments is None else arguments
    if not words or words[0] not in COMMANDS:
        for name, entry in joined().items():
            try:  # loaded, unless it is another one that is asked for
                told = words and words[0] in joined()
                summary = "" if told else str(entry.load().__doc__).splitlines()[0].rstrip(".")
                subparsers.add_parser(name, help=summary[:1].lower() + summary[1:])
            except Exception as error:  # whatever another package's code may raise
                _leave_out(entry, error)
        if not any(entry.value.startswith("mobius_flow.lab.") for entry in joined().values()):
            missing = "batch, atlas, gallery, compare and methods need an installation: python -m pip install ."
            logging.getLogger(__name__).warning(missing)
    if not words or words[0] not in subparsers.choices:
        top.check_known(top.parse_known_args(words)[1])
        top.print_help()
        top.exit(2, "mobius-flow: name a command")
    command = subparsers.choices[words[0]]
    add_to(command, words[0])  # which is loaded only now
    found, unknown = command.parse_known_intermixed_args(words[1:])  # options may stand between inputs and outputs
    command.check_known(unknown)
    found.command = words[0]
    return found
