"""What commands say: sentences, reports and tables, wrapped and coloured in a terminal and plain elsewhere."""

import contextlib
import io
import math
import os
import re
import shlex
import sys
from collections.abc import Iterable, Sequence
from typing import TextIO

GREEN, RED, YELLOW, FAINT = 32, 31, 33, 2
Item = str | Sequence[str]  # a text, whose words may be on different lines; or items that are left whole, such as paths


class OutputStreamError(OSError):
    """Standard output cannot be written."""


def emit(text: str) -> None:
    """Print to standard output, at once; raises OutputStreamError, or BrokenPipeError if the pipe is closed."""
    try:
        print(text, flush=True)
    except OSError as error:
        with contextlib.suppress(OSError, ValueError):  # the rest goes nowhere, so that Python's exit is quiet
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if isinstance(error, BrokenPipeError):
            raise
        reason = "it is closed" if isinstance(error, io.UnsupportedOperation) else error.strerror or error
        raise OutputStreamError(f"standard output cannot be written: {reason}") from error


def one_line(text: str) -> str:
    """A sentence in which line ends in names, and what no terminal can show, appear as backslash escapes."""
    return "".join(c if c.isprintable() else repr(c)[1:-1] for c in text)


def width_of(stream: TextIO) -> int | None:
    """Columns of a terminal; None for pipes and files."""
    if not stream.isatty():
        return None
    try:
        columns = int(os.environ.get("COLUMNS") or 0) or os.get_terminal_size(stream.fileno()).columns
    except (OSError, ValueError):
        columns = 0
    return max(columns or 80, 40)  # columns that lines are wrapped at; narrower terminals break them


def is_dumb(stream: TextIO) -> bool:
    """Whether it is no terminal, or one that knows neither colours nor how to erase a line."""
    return not stream.isatty() or os.environ.get("TERM") == "dumb"


def painted(text: str, colour: int, stream: TextIO) -> str:
    """A text in a colour where there are colours: in terminals, unless the environment says otherwise."""
    if not text or os.environ.get("NO_COLOR") or (is_dumb(stream) and not os.environ.get("FORCE_COLOR")):
        return text
    return f"\x1b[{colour}m{text}\x1b[0m"


def wrapped(item: Item, stream: TextIO, column: int = 0) -> str:
    """A text that begins in a column, and whose further lines begin there too."""
    items, between = (item.split(), " ") if isinstance(item, str) else (list(item), "  ")
    width, lines = width_of(stream), [""]
    for word in map(one_line, items):
        if width is not None and lines[-1] and column + len(lines[-1] + between + word) >= width:
            lines.append("")
        lines[-1] += (between if lines[-1] else "") + word
    return ("\n" + " " * column).join(lines)


def sentence(text: str, stream: TextIO) -> str:
    """A sentence of the program's, such as why it refuses something."""
    return wrapped(text, stream) if width_of(stream) else one_line(text)


def report(head: tuple[str, Item], rows: Iterable[tuple[str, Item]], stream: TextIO, colour: int = GREEN) -> str:
    """A headline, such as ✓ converged and what it took, above labels and what belongs to them.

    A text that is empty is left out with its label.
    """
    lines, rows = [], [row for row in rows if row[1]]
    width = max([14, *(len(label) + 3 for label, _ in rows)])  # columns of a report's labels
    for label, item, hue in ((*head, colour), *((f"  {name}", item, FAINT) for name, item in rows)):
        label = one_line(label)
        between = " " * max(width - len(label), 1 if label.startswith(" ") else 2)
        text = wrapped(item, stream, len(label + between))
        lines.append(painted(label, hue, stream) + between + text)
    return "\n".join(line.rstrip() for line in lines)


def table(head: Sequence[str], rows: Sequence[Sequence[str]], stream: TextIO) -> str:
    """Rows below the names of their columns; numbers stand at the right of theirs, and the last column is wrapped."""
    cells = [list(map(one_line, row)) for row in (head, *rows)]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    number = re.compile(r"(-?[\d.,]+(e[+-]?\d+)?)?")
    right = [all(map(number.fullmatch, column[1:])) for column in zip(*cells, strict=True)]

    lines = []
    for row in cells:
        padded = [
            cell.rjust(width) if is_right else cell.ljust(width)
            for cell, width, is_right in zip(row, widths, right, strict=True)
        ]
        start = "".join(f"{cell}  " for cell in padded[:-1])
        lines.append((start + (padded[-1] if right[-1] else wrapped(row[-1], stream, len(start)))).rstrip())
    return "\n".join([painted(lines[0], FAINT, stream), *lines[1:]])


def quoted(path: object) -> str:
    """A path as shells take it."""
    return shlex.quote(str(path))


def command(*words: object) -> str:
    """A command line to be copied."""
    return " ".join(["mobius-flow", *map(quoted, words)])


def digits(value: float, error: float, most: int = 9) -> str:
    """A number with the digits that its error leaves, two of which are doubtful.

    >>> digits(74.46382, 0.037), digits(4.0, 1e-12), digits(136.3812, 0.3)
    ('74.464', '4.00000000', '136.38')
    """
    if not (error > 0.0 and value):
        return f"{value:.{most}g}"
    size, last = (math.floor(math.log10(abs(x))) for x in (value, error))
    return f"{value:#.{min(max(size - last + 2, 2), most)}g}".rstrip(".")


def power(value: float) -> str:
    """A positive number as a power of ten, such as 1.7e-3."""
    mantissa, _, exponent = f"{value:.1e}".partition("e")
    return f"{mantissa}e{int(exponent)}" if value else "0"


def say_written(path: object, *following: object) -> None:
    """Tell on standard error what a command wrote, and which command may come next."""
    rows = [("next", [command(*following)] if following else "")]
    print(report(("✓ wrote", [quoted(path)]), rows, sys.stderr), file=sys.stderr)
