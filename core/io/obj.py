"""Wavefront OBJ (.obj): vertices ``v`` joined by polylines ``l``.

A polyline may run over many indices, also negative ones (counted back from the last vertex read), and
pieces in any order are joined where they share a vertex. Polylines that do not come back to their first vertex are open
polygons. Vertices on no line are dropped. A file with vertices alone is one closed polygon. Everything else in OBJ
is ignored, including faces ``f`` unless an obstacle is read.
"""

import logging
from dataclasses import dataclass, field
from itertools import pairwise
from typing import NamedTuple, TextIO

from ..base import shown
from ..curve import Curve
from .source import Polygon, Source

_log = logging.getLogger(__name__)

_NAMES = "vt vn vp p o g s mg usemtl mtllib usemap maplib cstype deg bmat step parm trim hole scrv sp end con bevel"
_RARE_NAMES = "c_interp d_interp lod shadow_obj trace_obj ctech stech surf curv2 call csh"
_IGNORED = frozenset(f"{_NAMES} {_RARE_NAMES}".split())


class ObjEdge(NamedTuple):
    """An edge between two vertices, and the line that says so."""

    tail: int
    head: int
    line: int


class Face(NamedTuple):
    """A face's words, the number of its line, and how many vertices came before it."""

    words: list[str]
    line: int
    known: int


@dataclass
class Content:
    """The contents of an OBJ file: vertices, the line of each, edges of polylines, and faces; indices count from 0."""

    points: list[tuple[float, ...]] = field(default_factory=list)
    lines: list[int] = field(default_factory=list)
    links: list[ObjEdge] = field(default_factory=list)
    faces: list[Face] = field(default_factory=list)


def read(source: Source) -> list[Polygon]:
    """Read the polygons; raises CurveFileError naming the line."""
    content = parsed(source)
    if content.faces:
        _log.warning("%s: %d faces (f) ignored; only polylines (l) are curves", source.path, len(content.faces))
    points, lines = content.points, content.lines
    chains: list[tuple[list[int], bool]] = []  # vertices joined by edges, and whether the last is joined to the first
    if content.faces and not content.links:
        raise source.error("there are faces (f) but no polylines (l); export the curve as edges")
    if not points and not content.links:
        raise source.error("no vertex (v) and no polyline (l) found")
    if not content.links:
        _log.warning("%s: no polyline (l); all %d vertices are taken as one closed polygon", source.path, len(points))
        chains.append((list(range(len(points))), True))
    at: dict[int, list[ObjEdge]] = {}
    for link in content.links:
        if link.tail == link.head:
            raise source.error(f"an edge joins vertex {link.tail + 1} to itself", link.line)
        for vertex in link[:2]:
            at.setdefault(vertex, []).append(link)
            if len(at[vertex]) > 2:
                reason = f"a third edge meets vertex {vertex + 1}; curves don't branch, and edges are given once"
                raise source.error(reason, link.line)
    # A closed chain starts at its smallest index and follows the direction of the edges there, so a file that lists its
    # polygon in order keeps that order. An open chain starts at the end with the smaller index.
    done: set[int] = set()
    for start in sorted(at, key=lambda vertex: (len(at[vertex]), vertex)):
        if start in done:
            continue
        link = min(at[start], key=lambda link: (link.tail != start, link.head + link.tail))
        chain, vertex = [start], link.head + link.tail - start
        while vertex != start:  # to its end, or round to the start
            chain.append(vertex)
            onward = [other for other in at[vertex] if other is not link]
            if not onward:
                break
            link = onward[0]
            vertex = link.head + link.tail - vertex
        done.update(chain)
        chains.append((chain, len(at[start]) == 2))
    chains.sort(key=lambda each: min(each[0]))
    return [
        Polygon([points[i] for i in chain], [lines[i] for i in chain].__getitem__, closed, chain)
        for chain, closed in chains
    ]


def parsed(source: Source) -> Content:
    """Read all statements; raises CurveFileError naming the line."""
    content, words, line = Content(), list[str](), 1
    for number, text in enumerate(source.lines, start=1):
        body = text.partition("#")[0].rstrip()
        line = line if words else number
        words += body.removesuffix("\\").split()
        if not words or (body.endswith("\\") and number < len(source.lines)):  # it goes on in the next line
            continue
        (keyword, *arguments), words = words, []
        if keyword == "v":
            if len(arguments) < 3:
                raise source.error(f"a vertex needs x y z, found {len(arguments)} numbers", line)
            content.points.append(tuple(source.number(word, line) for word in arguments[:3]))
            content.lines.append(line)
        elif keyword == "l":
            if len(arguments) < 2:
                raise source.error("a polyline (l) needs at least two vertices", line)
            indices = [index_of(source, argument, line, len(content.points)) for argument in arguments]
            content.links += (ObjEdge(tail, head, line) for tail, head in pairwise(indices))
        elif keyword == "f":
            content.faces.append(Face(arguments, line, len(content.points)))
        elif keyword == "curv":
            raise source.error(
                "free-form curves (curv) are not read; convert the curve to a polyline before export", line
            )
        elif keyword not in _IGNORED:
            raise source.error(f"{shown(keyword)} is not an OBJ statement", line)
    for link in content.links:
        check_known(source, max(link.tail, link.head), len(content.points), link.line)
    return content


def check_known(source: Source, index: int, known: int, line: int) -> None:
    """Raise a CurveFileError unless a vertex, counted from 0, is in the file."""
    if index >= known:
        raise source.error(f"vertex {index + 1} does not exist; there are {known}", line)


def index_of(source: Source, argument: str, line: int, known: int) -> int:
    """The vertex, from 0, of ``vertex`` or ``vertex/texture/normal``; negative numbers count back from ``known``."""
    index = source.integer(argument.partition("/")[0], line)
    if index == 0 or index < -known:
        raise source.error(f"vertex {index} does not exist; OBJ counts from 1, or back from -1", line)
    return index - 1 if index > 0 else known + index


def write(curve: Curve, stream: TextIO) -> None:
    """Write one ``l`` per component; a plane curve gets z = 0."""
    padding = [0.0] * (3 - curve.dimension)
    stream.writelines(f"v {' '.join(map(repr, point + padding))}\n" for point in curve.vertices.tolist())
    for part, closed in zip(curve.mesh.slices, curve.mesh.closed, strict=True):
        indices = [*range(part.start + 1, part.stop + 1), *([part.start + 1] if closed else [])]
        stream.write(f"l {' '.join(map(str, indices))}\n")
