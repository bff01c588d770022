"""Geomview VECT (.vect), as ridgerunner and KnotPlot use it: polylines with their numbers of vertices ahead.

``VECT``, then the numbers of polylines, vertices and colours; the vertices of each polyline, negative where
it is closed, else positive; the colours of each polyline; the points; the colours (which are ignored). ``#`` begins a
comment.
Source: the Geomview manual, section "VECT".
"""

from dataclasses import dataclass
from typing import TextIO

from ..base.errors import CurveError, CurveFileError
from ..curve.curve import Curve
from .source import Polygon, Source, shown


@dataclass
class _Words:
    """The words of a VECT file with their lines, taken one after the other."""

    source: Source
    words: list[tuple[str, int]]
    position: int = 0

    @property
    def left(self) -> int:
        return len(self.words) - self.position

    def error(self, reason: str) -> CurveFileError:
        """Make the error that names the line of the word read last."""
        return self.source.error(reason, self.words[max(self.position, 1) - 1][1])

    def demand(self, count: int, what: str) -> None:
        """Refuse a file that ends before ``count`` more words, before any memory is reserved for them."""
        if self.left < count:
            last = self.words[-1][1]
            raise self.source.error(f"the file is truncated: {count} {what} announced, {self.left} found", last)

    def integers(self, count: int, what: str) -> list[int]:
        self.demand(count, what)
        return [self.source.integer(*self.take()) for _ in range(count)]

    def numbers(self, count: int) -> list[float]:
        return [self.source.number(*self.take()) for _ in range(count)]

    def take(self) -> tuple[str, int]:
        self.position += 1
        return self.words[self.position - 1]


def read(source: Source) -> list[Polygon]:
    """Read the polygons; raises CurveFileError naming the line."""
    numbered = enumerate(source.lines, start=1)
    words = _Words(source, [(word, number) for number, line in numbered for word in line.partition("#")[0].split()])
    if not words.left:
        raise source.error("the file has comments only")
    magic = words.take()[0]
    if magic == "4VECT":
        raise words.error("VECT with four coordinates (4VECT) is not read; write three")
    if magic != "VECT":
        raise words.error(f"a VECT file starts with the word VECT, not {shown(magic)}")
    if words.left and words.words[1][0] == "BINARY":
        raise words.error("binary VECT is not read; write it as text")
    polylines, vertices, colours = words.integers(3, "numbers of polylines, vertices and colours")
    if min(polylines, vertices, colours) < 0:
        raise words.error("the header has a negative number")
    sizes = words.integers(polylines, "vertex counts")
    colour_sizes = words.integers(polylines, "colour counts")
    if sum(map(abs, sizes)) != vertices:
        raise words.error(f"the polylines have {sum(map(abs, sizes))} vertices together, the header says {vertices}")
    if min(colour_sizes, default=0) < 0 or sum(colour_sizes) != colours:
        raise words.error(f"the polylines have {sum(colour_sizes)} colours together, the header says {colours}")
    for k, size in enumerate(sizes, start=1):
        if size == 0:
            raise words.error(f"polyline {k} has no vertices; leave it out")
    words.demand(3 * vertices, "coordinates")
    polygons = []
    for size in sizes:
        lines = [line for _, line in words.words[words.position : words.position + 3 * abs(size) : 3]]
        values = words.numbers(3 * abs(size))
        points = list(zip(values[::3], values[1::3], values[2::3], strict=True))
        polygons.append(Polygon(points, lines.__getitem__, closed=size < 0))
    words.demand(4 * colours, "colour values")
    words.numbers(4 * colours)
    if words.left:
        raise source.error(f"{words.left} more words than the header announces", words.words[words.position][1])
    return polygons


def write(curve: Curve, stream: TextIO) -> None:
    """Write polylines without colours; a plane curve gets z = 0. Raises CurveError beyond three dimensions."""
    if curve.dimension > 3:
        raise CurveError(f"VECT holds curves of dimension 3, not {curve.dimension}; use .json")
    sizes = [-n if closed else n for n, closed in zip(curve.mesh.component_sizes, curve.mesh.closed, strict=True)]
    stream.write(f"VECT\n{len(sizes)} {len(curve)} 0\n")
    stream.write(" ".join(map(str, sizes)) + "\n" + " ".join("0" for _ in sizes) + "\n")
    padding = [0.0] * (3 - curve.dimension)
    stream.writelines(" ".join(map(repr, point + padding)) + "\n" for point in curve.vertices.tolist())
