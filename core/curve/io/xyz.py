"""Columns of coordinates (.txt, .xyz): one vertex per line, a blank line between components.

``#`` starts a comment, alone or after the numbers; columns are separated by spaces, tabs, commas or
semicolons. Three columns make a curve in space, two a plane curve.
"""

import re
from typing import TextIO

from ...errors import CurveError
from ..curve import Curve
from .polygons import Polygon
from .source import Source

_SEPARATOR = re.compile(r"\s*[,;]\s*|\s+")


def read(source: Source) -> list[Polygon]:
    """Read the polygons; raises CurveFileError naming the line."""
    blocks: list[tuple[list[tuple[float, ...]], list[int]]] = []
    columns: int | None = None
    apart = True
    for number, line in enumerate(source.lines, start=1):
        content, comment, _ = line.partition("#")
        if not content.strip():
            apart = apart or not comment
            continue
        point = _point(source, content.strip(), number, columns)
        columns = len(point)
        if apart:
            blocks.append(([], []))
        blocks[-1][0].append(point)
        blocks[-1][1].append(number)
        apart = False
    return [Polygon(points, lines.__getitem__) for points, lines in blocks]


def _point(source: Source, content: str, line: int, columns: int | None) -> tuple[float, ...]:
    fields = _SEPARATOR.split(content)
    point = tuple(source.number(field, line) for field in fields)
    if columns is not None and len(point) != columns:
        raise source.error(f"{len(point)} columns where the lines before have {columns}", line)
    if not 2 <= len(point) <= 3:
        noun = "column" if len(point) == 1 else "columns"
        advice = "; curves of higher dimension are read from .json" if len(point) > 3 else ""
        raise source.error(f"{len(point)} {noun} where x y z (or x y) is expected{advice}", line)
    return point


def write(curve: Curve, stream: TextIO) -> None:
    """Write the components, separated by blank lines; raises CurveError beyond three dimensions."""
    if curve.dimension > 3:
        raise CurveError(f"columns hold curves of dimension 2 or 3, not {curve.dimension}; use .json")
    blocks = ("\n".join(" ".join(map(repr, point)) for point in part.tolist()) for part in curve.components)
    stream.write("\n\n".join(blocks) + "\n")
