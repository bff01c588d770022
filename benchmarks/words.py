"""The command line of a benchmark: words of one kind, described in its docstring."""

from argparse import ArgumentParser, RawDescriptionHelpFormatter
from collections.abc import Callable, Sequence
from typing import TypeVar

_Word = TypeVar("_Word")


def words(doc: str | None, name: str, default: Sequence[_Word], kind: Callable[[str], _Word]) -> Sequence[_Word]:
    """The words given, or else the default ones."""
    parser = ArgumentParser(description=doc, formatter_class=RawDescriptionHelpFormatter)
    parser.add_argument(name, nargs="*", type=kind, default=default)
    given: Sequence[_Word] = getattr(parser.parse_args(), name)
    return given
