"""Knots and links from codes of their diagrams, as text and as files."""

from collections.abc import Callable, Mapping
from functools import partial
from math import pi
from types import MappingProxyType
from typing import TextIO

import numpy as np

from ..arguments import checked
from ..collision import check_embedded
from ..curve import Curve, check_closed, refine
from ..curve.io import FORMATS as CURVES
from ..curve.io import Format
from ..curve.io.polygons import Polygon
from ..curve.io.source import Source
from ..diagrams import Diagram, views
from ..diagrams.codes import diagram_from_code
from ..diagrams.nugatory import without_nugatory
from ..errors import CurveError
from ..types import FloatArray
from .planar import diagram_knot
from .rings import MAX_VERTICES

_CIRCLE = 12  # vertices of a component without crossings
_GAP = 0.5  # between parts that no crossing joins, all of radius 1
_VIEWS = 4


@checked
def coded_knot(text: str, vertices: int | None = None, kind: str | None = None) -> Curve:
    """Make the knot or link of a PD, DT or Gauss code as a polygon in space.

    Parameters
    ----------
    text, kind
        The code, as :func:`~mobius_flow.core.diagrams.codes.diagram_from_code` reads it.
    vertices
        Total number of vertices; by default four for every crossing, but for those that are nugatory.

    Raises
    ------
    CurveError
        If it is no code of a diagram in the plane, or the vertices are too few or too many.

    Examples
    --------
    >>> len(coded_knot("DT: [4 6 2]"))
    12
    """
    curve = drawn(diagram_from_code(text, kind))
    if vertices is None:
        return curve
    if not len(curve) <= vertices <= MAX_VERTICES:
        few = "few" if vertices < len(curve) else "many"
        raise CurveError(f"{vertices} vertices are too {few} for this diagram; give {len(curve)} to {MAX_VERTICES}")
    return refine(curve, vertices)


def drawn(diagram: Diagram) -> Curve:
    """A polygon that looks like a diagram from above, nugatory crossings left out; its parts lie side by side."""
    parts: list[FloatArray] = []
    for k, piece in enumerate(without_nugatory(diagram).pieces()):
        curve = diagram_knot(piece.planar_code) if piece.crossings else _circle()
        parts += [part + (2.0 + _GAP) * k * np.eye(3)[0] for part in curve.components]
    curve = Curve.from_components(parts)
    check_embedded(curve)
    return curve


def _circle() -> Curve:
    angle = 2.0 * pi * np.arange(_CIRCLE) / _CIRCLE
    return Curve(np.column_stack([np.cos(angle), np.sin(angle), np.zeros(_CIRCLE)]))


def _read(kind: str, source: Source) -> list[Polygon]:
    """Polygons of the code in a file, of which # begins comments."""
    text = "\n".join(line.partition("#")[0] for line in source.lines)
    try:
        curve = coded_knot(text, kind=kind)
    except CurveError as error:
        raise source.error(str(error)) from error
    return [Polygon(part.tolist(), _nowhere) for part in curve.components]


def _nowhere(_vertex: int) -> None:
    """No vertex of a drawing is in any line of the code."""


def _write(text_of: Callable[[Diagram], str], curve: Curve, stream: TextIO) -> None:
    """Write the code of a view of the curve; raises CurveError if there is no clear one, or none of open components."""
    check_closed(curve, "codes of diagrams")
    if curve.dimension != 3:
        raise CurveError(f"codes are of curves in space, not of dimension {curve.dimension}; use .json")
    found = min(views(curve, _VIEWS), key=lambda diagram: diagram.crossings, default=None)
    if found is None:
        raise CurveError("strands are so near to each other that no view of the curve tells which one is in front")
    stream.write(text_of(found) + "\n")


def planar_text(diagram: Diagram) -> str:
    """PD code, edges numbered from 1; raises CurveError for components without crossings, which it does not have."""
    if not all(diagram.passes):
        raise CurveError("PD codes have no components without crossings; use .gauss")
    crossings = (f"X[{','.join(str(edge + 1) for edge in edges)}]" for edges in diagram.planar_code)
    return f"PD[{', '.join(crossings)}]"


def gauss_text(diagram: Diagram) -> str:
    """Gauss code with signs, crossings numbered from 1."""
    signs = ["+" if sign > 0 else "-" for sign in diagram.signs]
    parts = ("".join(f"{'UO'[over]}{c + 1}{signs[c]}" for c, over in part) or "[]" for part in diagram.passes)
    return f"Gauss: {' / '.join(parts)}"


_CODES: Mapping[str, Format] = MappingProxyType(
    {
        suffix: Format(description, partial(_read, kind), text_of and partial(_write, text_of))
        for suffix, kind, description, text_of in (
            (".pd", "PD", "planar diagram code of a knot or link, PD[X[1,5,2,4], ...]", planar_text),
            (".dt", "DT", "Dowker-Thistlethwaite code, DT: [4 6 2] or DT: cacbca (read only)", None),
            (".gauss", "Gauss", "Gauss code, 1 -2 3 ... or with signs O1+U2+O3+...", gauss_text),
        )
    }
)
FORMATS: Mapping[str, Format] = MappingProxyType({**CURVES, **_CODES})
"""Formats of curves, and of diagrams that are drawn as curves."""
WRITTEN_FORMATS = [suffix for suffix, form in FORMATS.items() if form.write is not None]
"""Those that are not only read."""
