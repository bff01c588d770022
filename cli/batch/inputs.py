"""What the words of a batch's command line stand for: files, directories, patterns, knots and ranges of the table."""

import glob
import os
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from ...core import MobiusFlowError
from ...core.curve.io import FORMATS
from ...core.diagrams.codes import is_code
from ...core.knots import KNOTS, knot
from ...core.knots.names import table_name

_FORMULA = tuple("=+-@\t\r\n＝＋－＠")  # what begins one in a spreadsheet


@dataclass(frozen=True)
class Input:
    """A curve to start from.

    Attributes
    ----------
    name
        What its results are called.
    file
        Where it is read; None for a knot that is made by its name.
    """

    name: str
    file: Path | None = None


def inputs(words: Iterable[str]) -> list[Input]:
    """The inputs that words stand for, in their order, none twice; a MobiusFlowError tells words that name nothing."""
    found = dict.fromkeys(each for word in words for each in _meant(word))
    if not found:
        raise MobiusFlowError("there is nothing to relax: name a file, a directory or a knot")
    return list(found)


def _meant(word: str) -> Iterator[Input]:
    """Paths that exist come first, so that a file may be called like a knot."""
    if os.path.isdir(word):
        yield from _in_directory(Path(word))
    elif os.path.lexists(word):
        yield _of_file(Path(word))
    elif glob.has_magic(word) and (paths := sorted(glob.glob(word, recursive=True))):
        yield from _matching(paths)
    elif is_code(word):
        raise MobiusFlowError(f"{word[:60]}: codes name no folder; put it in a file that ends in .pd, .dt or .gauss")
    elif glob.has_magic(word):
        raise MobiusFlowError(f"{word}: matches no file")
    elif os.path.dirname(word) or Path(word).suffix.lower() in FORMATS:
        raise MobiusFlowError(f"{word}: there is no such file")
    elif ".." in word:
        yield from (Input(name) for name in _range(word))
    else:
        knot(word)  # which says what is wrong with names that mean nothing
        yield Input(word.strip())


def _of_file(path: Path) -> Input:
    """Results are called as the file; bytes that are no text are shown in hexadecimal, as tables have text only."""
    name = path.stem if path.stem.strip(".") else path.name  # nothing but dots is another directory
    return Input(as_text(os.fsencode(name).decode(errors="backslashreplace")), Path(os.path.abspath(path)))


def as_text(text: str) -> str:
    """What no spreadsheet takes for a formula, and runs."""
    return f"_{text}" if text.startswith(_FORMULA) else text


def _in_directory(directory: Path) -> Iterator[Input]:
    paths = sorted(each for each in directory.iterdir() if each.suffix.lower() in FORMATS)
    if not paths:
        raise MobiusFlowError(f"{directory}: holds no curve files; they end in {', '.join(FORMATS)}")
    yield from map(_of_file, paths)


def _matching(paths: Iterable[str]) -> Iterator[Input]:
    for path in map(Path, paths):
        yield from _in_directory(path) if path.is_dir() else [_of_file(path)]


def _range(word: str) -> list[str]:
    """The table's names from one to another, in its order."""
    table = list(KNOTS)
    first, last = (table_name(end) for end in word.split("..", 1))
    low, high = table.index(first[0]), table.index(last[0])
    if first[1] or last[1]:
        raise MobiusFlowError(f"{word}: the table has no mirror images; name them one by one")
    if low > high:
        raise MobiusFlowError(f"{word}: {last[0]} comes before {first[0]} in the table; swap them")
    return table[low : high + 1]
