"""The options and the task of a relaxation, shared by the subcommands that run one, and their record in results."""

import argparse
import platform
from collections.abc import Collection, Mapping
from dataclasses import MISSING
from typing import Any

import numpy
import scipy

from .. import __version__
from ..addon.pictures.looks import DEFAULT as DEFAULT
from ..addon.pictures.looks import LOOKS
from ..core import RelaxOptions, Task, read_obstacle
from ..core.base import BLAS, Option, OptionError, choice, declared
from ..core.io import CurveFile
from .parser import further

COMMON = "relaxation"
GROUPS = {  # of options, by the title that the help gives them
    COMMON: ("vertices", "max_iterations", "time_limit", "tolerance", "method", "untangle"),
    "what is minimised": ("energy", "barrier", "terms", "penalty", "accuracy", "solver"),
    "a rope": ("radius",),
    "gradients": ("metric", "quadrature_points"),
    "mesh and lengths": ("mesh", "edge_lengths", "grow"),
    "at rest, and beyond": ("balance", "stability", "escape_saddles", "hops", "seed", "symmetry"),
}


def add_to(parser: argparse.ArgumentParser, *, without: Collection[str] = ()) -> None:
    """Add the options to a parser, except those that a subcommand declares in its own way."""
    offered = {option.name: option for option in declared(RelaxOptions) if option.name not in without}
    named = {name for names in GROUPS.values() for name in names}
    for title, names in {**GROUPS, "further options": [name for name in offered if name not in named]}.items():
        if chosen := [offered[name] for name in names if name in offered]:
            group = parser.add_argument_group(title) if title == COMMON else further(parser, title)
            for option in chosen:
                add_option(group, option)
    parser.set_defaults(offered=list(offered))


def add_all(parser: argparse.ArgumentParser, owner: type) -> None:
    """Add all options of a dataclass to a parser."""
    for option in declared(owner):
        add_option(parser, option)
    parser.set_defaults(offered=[option.name for option in declared(owner)])


def add_option(group: argparse._ActionsContainer, option: Option) -> None:
    """Add an option as it is declared."""
    needed, metavar = option.default is MISSING, option.metavar or {int: "N", float: "X"}.get(option.kind, "NAME")
    declared_as: dict[str, Any] = {"dest": option.name, "default": None if needed else option.default}
    text = option.phrase
    if option.kind is bool:
        declared_as["action"] = "store_true"
    elif option.repeated:
        text += "; may be given several times"
        declared_as |= {"metavar": metavar, "action": "append", "default": []}
    else:
        text += f"; one of {', '.join(option.choices)}" if option.choices else ""
        text += "" if needed else f" (default: {option.automatic or '%(default)s'})"
        kind = option.kind if option.read is str else str
        declared_as |= {"metavar": metavar, "type": kind, "required": needed}
    group.add_argument(flag(option), help=text, **declared_as)


def from_arguments(arguments: argparse.Namespace, owner: type = RelaxOptions) -> Any:
    """The options, of a dataclass that declares them; raises OptionError if one is out of range."""
    wanted: dict[str, Any] = {}
    for option in declared(owner):
        if option.name in arguments.offered:
            value = getattr(arguments, option.name)
            if option.repeated:
                value = tuple(item for word in value for item in option.read(word))
            wanted[option.name] = option.read(value) if isinstance(value, str) else value
    return owner(**wanted)


def add_task(parser: argparse.ArgumentParser) -> None:
    """Add the constraints on a curve: pins and obstacles."""
    group = parser.add_argument_group("pins and obstacles")
    text = "OBJ file of triangles or polylines, in the curve's units, not to be touched; may be given several times"
    group.add_argument("--avoid", metavar="MESH.obj", action="append", default=[], help=text)
    text = (
        "vertices of the input that stay exactly in place, counted from 1; an arc that is straight from one to the "
        "next cannot move at all; may be given several times"
    )
    group.add_argument("--pin", dest="pins", metavar="V,V,…", action="append", default=[], help=text)
    text = "also pin the neighbours of pinned vertices in the refined start, which fixes the curve's direction there"
    group.add_argument("--pin-tangents", action="store_true", help=text)


def task(arguments: argparse.Namespace, file: CurveFile) -> Task:
    """The curve of a file with its obstacles and pins; pins are given in the file's own numbering."""
    pins = tuple(file.index_of(pin) for text in arguments.pins for pin in pinned(text))
    obstacles = tuple(map(read_obstacle, arguments.avoid))
    return Task(curve=file.curve, obstacles=obstacles, pins=pins, pin_tangents=arguments.pin_tangents)


def pinned(text: str) -> tuple[int, ...]:
    """Indices of vertices that are counted from 1, separated by commas."""
    return tuple(number - 1 for number in listed(text, 1, "{} is not a vertex number; count from 1, such as 12,40"))


def listed(text: str, least: int, refusal: str) -> list[int]:
    """Whole numbers separated by commas; raises OptionError, which names the first word that is not one."""
    words = [word.strip() for word in text.split(",")]
    for word in words:
        if not (word.isascii() and word.isdecimal() and least <= int(word[:20])):
            raise OptionError(refusal.format(f"{word!r:.40}"))
    return [int(word[:20]) for word in words]


def inputs(arguments: argparse.Namespace, **paths: str) -> dict[str, str]:
    """The files that are read, by their names on the command line: the one that is the input, or some others."""
    return (paths or {"IN": arguments.input}) | {f"--avoid {path}": path for path in arguments.avoid}


def flag(option: Option) -> str:
    """The option's name on the command line."""
    return f"--{option.flag or option.name.replace('_', '-')}"


def look(word: str, *others: str) -> str:
    """The name of a look, or one of some other words allowed in its place."""
    names = [*(name.lower() for name in LOOKS), *others]
    if word not in names:
        raise argparse.ArgumentTypeError(f"{word!r:.40} is unknown; {choice(word, names)}")
    return word if word in others else word.upper()


def provenance(options: Mapping[str, object], name: str, sha256: str | None) -> dict[str, object]:
    """The provenance of a result: enough to make it again, bit for bit with the same libraries and BLAS threads."""
    return {"options": options, "input": {"name": name, "sha256": sha256}, **environment()}


def environment() -> dict[str, object]:
    """The version, the BLAS threads and the libraries, as plain values."""
    return {
        "version": __version__,
        "blas_threads": BLAS.threads,
        "python": platform.python_version(),
        "numpy": numpy.__version__,
        "scipy": scipy.__version__,
    }
