"""Knots and links from codes of their diagrams."""

from math import pi

import numpy as np

from ..arguments import checked
from ..collision import check_embedded
from ..curve import Curve, refine
from ..diagrams import Diagram
from ..diagrams.codes import diagram_from_code
from ..diagrams.nugatory import without_nugatory
from ..errors import CurveError
from ..types import FloatArray
from .planar import diagram_knot
from .rings import MAX_VERTICES

_CIRCLE = 12  # vertices of a component without crossings
_GAP = 0.5  # between parts that no crossing joins, all of radius 1


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
