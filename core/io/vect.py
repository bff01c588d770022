"""Geomview VECT (.vect), as ridgerunner and KnotPlot use it: polylines with their numbers of vertices ahead.

``VECT``, then the numbers of polylines, vertices and colours; the vertices of each polyline, negative where
it is closed, else positive; the colours of each polyline; the points; the colours (which are ignored). ``#`` begins a
comment.
Source: the Geomview manual, section "VECT".
"""

from itertools import islice
from typing import TextIO

from ..base import shown
from ..curve import Curve
from .source import Polygon, Source


def read(source: Source) -> list[Polygon]:
    """Read the polygons; raises CurveFileError naming the line."""
    numbered = enumerate(source.lines, start=1)
    words = [(word, number) for number, line in numbered for word in line.partition("#")[0].split()]
    if not words:
        raise source.error("the file has comments only")
    magic, line = words[0]
    if magic == "4VECT":
        raise source.error("VECT with four coordinates (4VECT) is not read; write three", line)
    if magic != "VECT":
        raise source.error(f"a VECT file starts with the word VECT, not {shown(magic)}", line)
    if words[1:] and words[1][0] == "BINARY":
        raise source.error("binary VECT is not read; write it as text", line)
    at = 1

    def take(count: int, what: str) -> list[tuple[str, int]]:
        """The next words; refuses a file that ends before, and reserves no memory for them."""
        nonlocal at, line
        if len(words) < at + count:
            found = f"{count} {what} announced, {len(words) - at} found"
            raise source.error(f"the file is truncated: {found}", words[-1][1])
        at += count
        line = words[at - 1][1]
        return words[at - count : at]

    def integers(count: int, what: str) -> list[int]:
        return [source.integer(*each) for each in take(count, what)]

    polylines, vertices, colours = integers(3, "numbers of polylines, vertices and colours")
    if min(polylines, vertices, colours) < 0:
        raise source.error("the header has a negative number", line)
    sizes, colour_sizes = integers(polylines, "vertex counts"), integers(polylines, "colour counts")
    if (total := sum(map(abs, sizes))) != vertices:
        raise source.error(f"the polylines have {total} vertices together, the header says {vertices}", line)
    if min(colour_sizes, default=0) < 0 or sum(colour_sizes) != colours:
        raise source.error(f"the polylines have {sum(colour_sizes)} colours together, the header says {colours}", line)
    if 0 in sizes:
        raise source.error(f"polyline {sizes.index(0) + 1} has no vertices; leave it out", line)
    coordinates, polygons = iter(take(3 * vertices, "coordinates")), list[Polygon]()
    for size in sizes:
        own = list(islice(coordinates, 3 * abs(size)))
        values, lines = [source.number(*each) for each in own], [number for _, number in own[::3]]
        points = list(zip(values[::3], values[1::3], values[2::3], strict=True))
        polygons.append(Polygon(points, lines.__getitem__, closed=size < 0))
    for each in take(4 * colours, "colour values"):
        source.number(*each)
    if words[at:]:
        raise source.error(f"{len(words) - at} more words than the header announces", words[at][1])
    return polygons


def write(curve: Curve, stream: TextIO) -> None:
    """Write polylines without colours; a plane curve gets z = 0."""
    sizes = [-n if closed else n for n, closed in zip(curve.mesh.component_sizes, curve.mesh.closed, strict=True)]
    stream.write(f"VECT\n{len(sizes)} {len(curve)} 0\n")
    stream.write(" ".join(map(str, sizes)) + "\n" + " ".join("0" for _ in sizes) + "\n")
    padding = [0.0] * (3 - curve.dimension)
    stream.writelines(" ".join(map(repr, point + padding)) + "\n" for point in curve.vertices.tolist())
