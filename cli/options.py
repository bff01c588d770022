"""The options of a relaxation, shared by the subcommands that run one."""

import argparse
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from ..core import RelaxOptions
from ..core.curve.io import CurveFile
from ..core.option import Option, declared


def add_to(parser: argparse.ArgumentParser, *, method: bool = True) -> None:
    """Add the options to a parser; ``method`` is left out where several are run."""
    group = parser.add_argument_group("relaxation")
    for option in declared(RelaxOptions):
        if method or option.name != "method":
            group.add_argument(flag(option), default=option.default, help=_help(option), **_values(option))
            for word, value in option.shorthands.items():
                text = f"the same as {flag(option)} {value}"
                group.add_argument(f"--{word}", dest=option.name, action=_Farther, const=(option, value), help=text)


def from_arguments(arguments: argparse.Namespace) -> RelaxOptions:
    """The options; raises OptionError if one is out of range."""
    given, names = vars(arguments), [option.name for option in declared(RelaxOptions)]
    return RelaxOptions(**{name: given[name] for name in names if name in given})


def about(file: CurveFile, options: RelaxOptions) -> RelaxOptions:
    """The options with the vertices that a file's own numbers stand for; raises CurveFileError if it has none such."""
    return replace(options, pins=tuple(map(file.index_of, options.pins)))


def flag(option: Option) -> str:
    """What the option is called on the command line."""
    return f"--{option.ordinals or option.name.replace('_', '-')}"


def _values(option: Option) -> dict[str, Any]:
    if option.ordinals:
        return {"dest": option.name, "action": _Ordinals, "metavar": option.metavar}
    return {"action": "store_true"} if option.kind is bool else {"type": option.kind, "metavar": option.metavar}


def _help(option: Option) -> str:
    if option.kind is bool:
        return option.help
    choices = f": one of {', '.join(option.choices)}" if option.choices else ""
    return f"{option.help}{choices} (default: {option.automatic or option.default or 'none'})"


class _Ordinals(argparse.Action):
    """Numbers of vertices with commas between, counted from 1 as in OBJ; given again, there are more of them."""

    def __call__(self, _parser: Any, namespace: argparse.Namespace, text: Any, _flag: str | None = None) -> None:
        words = [word.strip() for word in text.split(",")]
        wrong = next((word for word in words if not (word.isascii() and word.isdecimal() and int(word[:20]) > 0)), None)
        if wrong is not None:
            raise argparse.ArgumentError(self, f"{wrong!r:.40} is no vertex; give numbers from 1, such as 12,40")
        given = getattr(namespace, self.dest)
        setattr(namespace, self.dest, (*given, *(int(word[:18]) - 1 for word in words)))


class _Farther(argparse.Action):
    """A flag that stands for a choice; of several the one that comes last in the list of choices holds."""

    def __init__(self, option_strings: Sequence[str], dest: str, const: tuple[Option, str], help: str) -> None:
        super().__init__(option_strings, dest, nargs=0, const=const, default=const[0].default, help=help)

    def __call__(self, _parser: Any, namespace: argparse.Namespace, _values: Any, _flag: str | None = None) -> None:
        option, value = self.const
        choices = list(option.choices)
        given = getattr(namespace, self.dest)
        setattr(namespace, self.dest, max(value, given, key=choices.index) if given in choices else given)
