"""Columns of coordinates (.txt, .xyz): one vertex per line, a blank line between components.

``#`` starts a comment, alone or after the numbers; columns are separated by spaces, tabs, commas or
semicolons. Three columns make a curve in space, two a plane curve. Components are closed; the line ``# open`` begins an
open one.
"""

import re
from dataclasses import dataclass, field
from typing import TextIO

from ...errors import CurveError
from ..curve import Curve
from .polygons import Polygon
from .source import Source

_SEPARATOR = re.compile(r"\s*[,;]\s*|\s+")
_OPEN = "open"  # the comment that begins an open component


@dataclass
class _Block:
    """One component: its points and their lines."""

    closed: bool
    points: list[tuple[float, ...]] = field(default_factory=list)
    lines: list[int] = field(default_factory=list)


def read(source: Source) -> list[Polygon]:
    """Read the polygons; raises CurveFileError naming the line."""
    blocks: list[_Block] = []
    columns: int | None = None
    apart, closed = True, True
    for number, line in enumerate(source.lines, start=1):
        content, sign, comment = line.partition("#")
        if not content.strip():
            begins_open = comment.strip() == _OPEN
            apart, closed = apart or not sign or begins_open, closed and not begins_open
            continue
        point = _point(source, content.strip(), number, columns)
        columns = len(point)
        if apart:
            blocks.append(_Block(closed))
        blocks[-1].points.append(point)
        blocks[-1].lines.append(number)
        apart, closed = False, True
    return [Polygon(block.points, block.lines.__getitem__, block.closed) for block in blocks]


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
    heads = ("" if closed else f"# {_OPEN}\n" for closed in curve.mesh.closed)
    stream.write("\n\n".join(head + block for head, block in zip(heads, blocks, strict=True)) + "\n")
