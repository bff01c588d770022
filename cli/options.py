"""The options of a relaxation, shared by the subcommands that run one."""

import argparse
from collections.abc import Sequence
from typing import Any

from ..core import RelaxOptions, Task, read_obstacle
from ..core.curve.io import CurveFile
from ..core.errors import OptionError
from ..core.option import Option, declared


def add_to(parser: argparse.ArgumentParser, *, method: bool = True) -> None:
    """Add the options to a parser; ``method`` is left out where several are run."""
    group = parser.add_argument_group("relaxation")
    for option in declared(RelaxOptions):
        if method or option.name != "method":
            group.add_argument(flag(option), help=_help(option), **_values(option))
            for word, value in option.shorthands.items():
                text = f"the same as {flag(option)} {value}"
                group.add_argument(f"--{word}", dest=option.name, action=_Farther, const=(option, value), help=text)


def from_arguments(arguments: argparse.Namespace) -> RelaxOptions:
    """The options; raises OptionError if one is out of range."""
    given = vars(arguments)
    wanted = {each.name: _value(each, given[each.name]) for each in declared(RelaxOptions) if each.name in given}
    return RelaxOptions(**wanted)


def add_task(parser: argparse.ArgumentParser) -> None:
    """Add what a curve is to respect."""
    group = parser.add_argument_group("what stands still")
    text = "OBJ file of triangles or polylines, in the curve's units, that it never touches; may be given several times"
    group.add_argument("--avoid", metavar="MESH.obj", action="append", default=[], help=text)
    text = (
        "vertices of the input that stay exactly where they are, counted from 1; nothing can move on an arc that is "
        "straight from one of them to the next; may be given several times"
    )
    group.add_argument("--pin", dest="pins", metavar="V,V,…", action="append", default=[], help=text)
    text = "pin the neighbours that pinned vertices have in the refined start too, and so the curve's direction there"
    group.add_argument("--pin-tangents", action="store_true", help=text)


def task(arguments: argparse.Namespace, file: CurveFile) -> Task:
    """The curve of a file with its obstacles and pins, which a file's own numbers stand for."""
    again = next((path for path in arguments.avoid if arguments.avoid.count(path) > 1), None)
    if again is not None:
        raise OptionError(f"--avoid names {again:.60} more than once")
    return Task(
        curve=file.curve,
        obstacles=tuple(map(read_obstacle, arguments.avoid)),
        pins=tuple(file.index_of(pin) for text in arguments.pins for pin in pinned(text)),
        pin_tangents=arguments.pin_tangents,
    )


def pinned(text: str) -> tuple[int, ...]:
    """Indices of vertices that are counted from 1, with commas between."""
    words = [word.strip() for word in text.split(",")]
    wrong = next((word for word in words if not (word.isascii() and word.isdecimal() and int(word[:20]) > 0)), None)
    if wrong is not None:
        raise OptionError(f"{wrong!r:.40} is no vertex to pin; give numbers from 1, such as 12,40")
    return tuple(int(word[:20]) - 1 for word in words)


def inputs(arguments: argparse.Namespace) -> dict[str, str]:
    """The files that are read, by what they are on the command line."""
    return {"IN": arguments.input, **{f"--avoid {path}": path for path in arguments.avoid}}


def _value(option: Option, given: Any) -> Any:
    """What is given, with words turned into the items of a tuple."""
    if not option.repeated:
        return given
    again = next((word for word in given if given.count(word) > 1), None)
    if again is not None:
        raise OptionError(f"{flag(option)} names {again:.60} more than once")
    return tuple(item for word in given for item in option.read(word))


def flag(option: Option) -> str:
    """What the option is called on the command line."""
    return f"--{option.flag or option.name.replace('_', '-')}"


def _values(option: Option) -> dict[str, Any]:
    common = {"dest": option.name, "default": [] if option.repeated else option.default}
    if option.kind is bool:
        return common | {"action": "store_true"}
    return common | {"metavar": option.metavar} | ({"action": "append"} if option.repeated else {"type": option.kind})


def _help(option: Option) -> str:
    if option.kind is bool:
        return option.help
    if option.repeated:
        return f"{option.help}; may be given several times"
    choices = f": one of {', '.join(option.choices)}" if option.choices else ""
    return f"{option.help}{choices} (default: {option.automatic or option.default})"


class _Farther(argparse.Action):
    """A flag that stands for a choice; of several the one that comes last in the list of choices holds."""

    def __init__(self, option_strings: Sequence[str], dest: str, const: tuple[Option, str], help: str) -> None:
        super().__init__(option_strings, dest, nargs=0, const=const, default=const[0].default, help=help)

    def __call__(self, _parser: Any, namespace: argparse.Namespace, _values: Any, _flag: str | None = None) -> None:
        option, value = self.const
        choices = list(option.choices)
        given = getattr(namespace, self.dest)
        setattr(namespace, self.dest, max(value, given, key=choices.index) if given in choices else given)
