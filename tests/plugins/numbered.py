"""A file format: the number of the component, negative where it is open, x, y and z, separated by commas."""

from itertools import groupby
from typing import TextIO

from ..curve import Curve
from .source import Polygon, Source


def read(source: Source) -> list[Polygon]:
    """Read the polygons; raises CurveFileError naming the line."""
    rows = [(number, line.split(",")) for number, line in enumerate(source.lines, start=1) if line.strip()]
    polygons = []
    for component, group in groupby(rows, key=lambda row: row[1][0]):
        part = list(group)
        points = [tuple(source.number(word, number) for word in words[1:]) for number, words in part]
        polygons.append(Polygon(points, [number for number, _ in part].__getitem__, not component.startswith("-")))
    return polygons


def write(curve: Curve, stream: TextIO) -> None:
    """Write one vertex per line."""
    for number, (part, closed) in enumerate(zip(curve.components, curve.mesh.closed, strict=True), start=1):
        sign = "" if closed else "-"
        stream.writelines(f"{sign}{number},{','.join(map(repr, point))}\n" for point in part.tolist())
