"""From the polygons found in a file to a curve, with errors that point to the line."""

import logging
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ...errors import CurveError
from ..curve import Curve
from .source import Source

MAX_DIMENSION = 16  # embeddedness is looked at in each of its planes
_log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Polygon:
    """One component as found in a file.

    Parameters
    ----------
    points
        Its vertices, each a sequence of m coordinates.
    line_of
        Gives the line where the vertex of an index (from 0) was read.
    closed
        Whether an edge leads from the last vertex to the first; it is also closed if these are the same point.
    numbers
        What the file counts its vertices as, from 0, where these can be in another order than along the curve.
    """

    points: Sequence[Sequence[float]]
    line_of: Callable[[int], int | None]
    closed: bool = True
    numbers: Sequence[int] | None = None

    @property
    def repeats_first(self) -> bool:
        """Whether the last vertex is at the first."""
        return len(self.points) > 1 and list(self.points[0]) == list(self.points[-1])


def assemble(source: Source, polygons: Sequence[Polygon]) -> Curve:
    """Check the polygons of a file and join them into one curve.

    Raises
    ------
    CurveFileError
        If there is none, one has too few vertices, a coordinate is not finite, or dimensions differ or are too many;
        the message names the component, the vertex and the line.
    """
    if not polygons:
        raise source.error("no vertex found; give at least one polygon")
    dimension = len(polygons[0].points[0]) if polygons[0].points else 0
    if dimension > MAX_DIMENSION:
        reason = f"vertices have {dimension} coordinates; there may be at most {MAX_DIMENSION}"
        raise source.error(reason, polygons[0].line_of(0))
    components = []
    for number, polygon in enumerate(polygons, start=1):
        _check_points(source, number, polygon, dimension)
        components.append(_without_closing_point(source, number, polygon))
    try:
        return Curve.from_components(components, [each.closed or each.repeats_first for each in polygons])
    except CurveError as error:
        raise source.error(str(error)) from error


def _check_points(source: Source, number: int, polygon: Polygon, dimension: int) -> None:
    for i, point in enumerate(polygon.points):
        if len(point) != dimension:
            reason = f"component {number}, vertex {i + 1} has {len(point)} coordinates, the first vertex {dimension}"
            raise source.error(reason, polygon.line_of(i))
        if not all(map(math.isfinite, point)):
            reason = f"component {number}, vertex {i + 1} is not finite: {list(point)}"
            raise source.error(reason, polygon.line_of(i))


def _without_closing_point(source: Source, number: int, polygon: Polygon) -> Sequence[Sequence[float]]:
    """Drop a last vertex that repeats the first, and refuse what is then no polygon."""
    points = polygon.points
    if polygon.repeats_first:
        _log.warning(
            "%s: the last vertex of component %d repeats its first; dropped, since polygons close by themselves",
            source.path,
            number,
        )
        points = points[:-1]
    closed = polygon.closed or polygon.repeats_first
    if len(points) < (least := 3 if closed else 2):
        count = "1 vertex" if len(points) == 1 else f"{len(points)} vertices"
        kind = "a closed polygon" if closed else "an open polygon"
        reason = f"component {number} has {count}; {kind} needs at least {least} different vertices"
        raise source.error(reason, polygon.line_of(0) if points else None)
    return points
