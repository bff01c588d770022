"""Codes of diagrams (.pd, .dt, .gauss, Knoodle's .tsv): read as a drawing of the diagram, written from a view.

``#`` begins a comment.  For the forms of the codes see :mod:`mobius_flow.core.diagrams.codes`.
"""

from collections.abc import Callable
from functools import partial
from typing import TextIO

from ...diagrams import Diagram, diagram_of, views
from ...diagrams.codes import check_count, diagram_from_code, gauss_text, joined, planar_text
from ...diagrams.nested import CodeError
from ...errors import CurveError, CurveFileError
from ...knots.planar import drawn
from ..curve import Curve, check_closed
from . import xyz
from .source import Polygon, Source

_VIEWS = 4
_EDGES = 4  # in a row of Knoodle's, before the sign and two colours
_COLUMNS = range(_EDGES, _EDGES + 4)


def _read(kind: str, source: Source) -> list[Polygon]:
    """Polygons of the code in a file; raises CurveFileError."""
    text = "\n".join(line.partition("#")[0] for line in source.lines)
    try:
        return _polygons(drawn(diagram_from_code(text, kind)))
    except CodeError as error:
        raise source.error(str(error), text.count("\n", 0, error.position) + 1) from error
    except CurveError as error:
        raise source.error(str(error)) from error


read_pd, read_dt, read_gauss = (partial(_read, kind) for kind in ("pd", "dt", "gauss"))


def read_tsv(source: Source) -> list[Polygon]:
    """Polygons of coordinates, or of a knot's crossings, as `knoodle_diagrams` reads them; or CurveFileError."""
    found = knoodle_diagrams(source)
    if not found:
        return xyz.read(source)
    if len(found) > 1:
        raise source.error(f"{len(found)} knots; mobius-flow knot FILE DIRECTORY makes a file for each")
    try:
        return _polygons(drawn(found[0]))
    except CurveError as error:
        raise source.error(str(error)) from error


def knoodle_diagrams(source: Source) -> list[Diagram]:
    """The diagrams in a file of Knoodle's; none if there are no crossings.  Raises CurveFileError.

    Lines have a crossing's four edges, its sign if it is given, and colours, which are ignored.  A line with ``k``
    begins a knot, and with ``s`` a summand of it; one without crossings is a circle.
    """
    knots: list[list[list[tuple[int, list[int]]]]] = []  # summands of crossings with their lines
    columns = 0
    for number, line in enumerate(source.lines, start=1):
        words = line.partition("#")[0].split()
        mark = words[0].lower() if words else ""
        if not knots and mark and mark not in ("k", "l", "s", "u") and len(words) not in _COLUMNS:
            return []
        if mark in ("k", "l") or (mark and not knots):
            knots.append([])
        if mark in ("s", "u") or (mark and mark not in ("k", "l") and not knots[-1]):
            knots[-1].append([])
        if not mark or mark in ("k", "l", "s", "u"):
            continue
        if len(words) != (columns := columns or len(words)) or columns not in _COLUMNS:
            raise source.error(f"{len(words)} columns; all crossings have as many, 4 to 7", number)
        knots[-1][-1].append((number, [source.integer(word, number) for word in words]))
    try:
        return [joined([_crossings(source, rows) for rows in summands]) for summands in knots]
    except CurveFileError:
        raise
    except CurveError as error:
        raise source.error(str(error)) from error


def _crossings(source: Source, rows: list[tuple[int, list[int]]]) -> Diagram:
    """The diagram of crossings with their lines; raises CurveError if there is none, or given signs contradict it."""
    check_count(len(rows))
    diagram = diagram_of([edges[:_EDGES] for _, edges in rows])
    for (number, edges), sign, (a, b) in zip(rows, diagram.signs, diagram.joins(), strict=True):
        if a == b and len(edges) % 2 and edges[_EDGES] != sign:
            raise source.error(f"the sign of this crossing is {edges[_EDGES]}, but its edges make it {sign}", number)
    return diagram


def _polygons(curve: Curve) -> list[Polygon]:
    """The polygons of a drawing, whose vertices are on no line of the code."""
    return [Polygon(part.tolist(), lambda _: None) for part in curve.components]


def _written(text_of: Callable[[Diagram], str], curve: Curve, stream: TextIO) -> None:
    """Write the code of a view of the curve; raises CurveError if no view is clear, or a component is open."""
    check_closed(curve, "codes of diagrams")
    if curve.dimension != 3:
        raise CurveError(f"codes are of curves in space, not of dimension {curve.dimension}; use .json")
    found = min(views(curve, _VIEWS), key=lambda diagram: diagram.crossings)
    stream.write(text_of(found) + "\n")


write_pd, write_gauss = partial(_written, planar_text), partial(_written, gauss_text)
