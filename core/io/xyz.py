"""Columns of coordinates (.txt, .xyz, .csv, .tsv): one vertex per line, a blank line between components.

``#`` starts a comment, alone or after the numbers; columns are separated by spaces, tabs, commas or
semicolons. Three columns make a curve in space, two a plane curve; under a first line with names among which are x, y
and z other columns are ignored. Components are closed; the line ``# open`` begins an open one.
"""

import re
from collections.abc import Callable
from typing import TextIO

from ..curve import Curve
from .source import Polygon, Source

_SEPARATOR = re.compile(r"\s*[,;]\s*|\s+")
_OPEN = "open"  # the comment that begins an open component


def read(source: Source) -> list[Polygon]:
    """Read the polygons; raises CurveFileError naming the line."""
    components: list[tuple[list[tuple[float, ...]], list[int], bool]] = []  # points, their lines, whether closed
    columns: int | None = None
    chosen: list[int] | None = None
    apart, closed = True, True
    for number, line in enumerate(source.lines, start=1):
        content, sign, comment = line.partition("#")
        if not content.strip():
            begins_open = comment.strip() == _OPEN
            apart, closed = apart or not sign or begins_open, closed and not begins_open
            continue
        words = _SEPARATOR.split(content.strip())
        if columns is None and {"x", "y"} <= set(names := [word.strip("\"'").lower() for word in words]):
            columns, chosen = len(words), [names.index(axis) for axis in "xyz" if axis in names]
            continue
        if columns is not None and len(words) != columns:
            raise source.error(f"{len(words)} columns where the lines before have {columns}", number)
        point = tuple(source.number(word, number) for word in (words if chosen is None else [words[k] for k in chosen]))
        if not 2 <= len(point) <= 3:
            noun = "column" if len(point) == 1 else "columns"
            advice = "; curves of higher dimension are read from .json" if len(point) > 3 else ""
            raise source.error(f"{len(point)} {noun} where x y z (or x y) is expected{advice}", number)
        columns = len(words)
        if apart:
            components.append(([], [], closed))
        components[-1][0].append(point)
        components[-1][1].append(number)
        apart, closed = False, True
    return [Polygon(points, lines.__getitem__, closed) for points, lines, closed in components]


def separated(separator: str, head: bool = False) -> Callable[[Curve, TextIO], None]:
    """A writer of components separated by blank lines, with or without axes' names."""

    def write(curve: Curve, stream: TextIO) -> None:
        stream.write(separator.join("xyz"[: curve.dimension]) + "\n" if head else "")
        lines = ("\n".join(separator.join(map(repr, point)) for point in part.tolist()) for part in curve.components)
        marks = ("" if closed else f"# {_OPEN}\n" for closed in curve.mesh.closed)
        stream.write("\n\n".join(mark + block for mark, block in zip(marks, lines, strict=True)) + "\n")

    return write
