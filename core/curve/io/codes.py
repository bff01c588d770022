"""Codes of diagrams (.pd, .dt, .gauss, Knoodle's .tsv): read as a drawing of the diagram, written from a view.

``#`` begins a comment.  What the codes may look like: :mod:`mobius_flow.core.diagrams.codes`.
"""

from collections.abc import Callable
from functools import partial
from typing import TextIO

from ...diagrams import Diagram, diagram_of, views
from ...diagrams.codes import check_count, diagram_from_code, gauss_text, planar_text
from ...diagrams.nested import CodeError
from ...errors import CurveError, CurveFileError
from ...knots.planar import drawn
from ..curve import Curve, check_closed
from . import xyz
from .source import Polygon, Source

_VIEWS = 4
_EDGES = 4  # in a row of Knoodle's, before the sign


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
    """Polygons of coordinates, or of crossings: four edges in a line, and a sign if it is given; or CurveFileError."""
    rows = [(number, line.partition("#")[0].split()) for number, line in enumerate(source.lines, start=1)]
    rows = [(number, words) for number, words in rows if words]
    if not rows or not _EDGES <= len(rows[0][1]) <= _EDGES + 1:
        return xyz.read(source)
    code = []
    for number, words in rows:
        if len(words) != len(rows[0][1]):
            raise source.error(f"{len(words)} columns where the lines before have {len(rows[0][1])}", number)
        code.append([source.integer(word, number) for word in words])
    try:
        check_count(len(code))
        diagram = diagram_of([edges[:_EDGES] for edges in code])
        for (number, _), edges, sign, (a, b) in zip(rows, code, diagram.signs, diagram.joins(), strict=True):
            if a == b and edges[_EDGES:] not in ([], [sign]):
                raise source.error(
                    f"the sign of this crossing is {edges[_EDGES]}, but its edges make it {sign}", number
                )
        return _polygons(drawn(diagram))
    except CurveFileError:
        raise
    except CurveError as error:
        raise source.error(str(error)) from error


def _polygons(curve: Curve) -> list[Polygon]:
    """Those of a drawing, whose vertices are in no line of the code."""
    return [Polygon(part.tolist(), lambda _: None) for part in curve.components]


def _written(text_of: Callable[[Diagram], str], curve: Curve, stream: TextIO) -> None:
    """Write the code of a view of the curve; raises CurveError if there is no clear one, or none of open components."""
    check_closed(curve, "codes of diagrams")
    if curve.dimension != 3:
        raise CurveError(f"codes are of curves in space, not of dimension {curve.dimension}; use .json")
    found = min(views(curve, _VIEWS), key=lambda diagram: diagram.crossings)
    stream.write(text_of(found) + "\n")


write_pd, write_gauss = partial(_written, planar_text), partial(_written, gauss_text)
