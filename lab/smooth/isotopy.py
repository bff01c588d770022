"""Polygons that are proved to be ambient isotopic to smooth knots and links (docs/bounds.md)."""

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations_with_replacement

import numpy as np

from ...core.base import ComplexArray, CurveError, FloatArray, checked
from ...core.curve import Curve
from ...core.knots.shapes import SmoothShape
from .covering import CurveArcs, PolygonEdges, cover, points, scaled

_REFUSAL = "the curve meets itself or has a cusp, or nearly so: its type cannot be proved"


@checked
def inscribed(coefficients: Sequence[ComplexArray]) -> Curve:
    """Inscribe a polygon in a smooth knot or link, at equal steps, which is proved to be ambient isotopic to it.

    ``coefficients`` has an array for each component, shape (modes + 1, 3), as in `FourierCurve`.  Raises CurveError
    where nothing is proved because the curve meets itself or has a cusp, or nearly so.
    """
    coefficients, power = scaled(coefficients)
    arcs = _apart(coefficients)
    for factor in 0.6 * 1.2 ** np.arange(30):  # times the vertices that curvature alone asks for
        sizes = [math.ceil(max(3.0, factor / one.height)) for one in arcs]
        polygon = SmoothShape(tuple(coefficients)).polygon(sizes)
        polygon = polygon.with_vertices(np.ldexp(polygon.vertices, -power))
        if _follows(arcs, coefficients, polygon, power):
            return polygon
    raise CurveError(_REFUSAL)


@checked
def proves(coefficients: Sequence[ComplexArray], curve: Curve) -> bool:
    """Whether a polygon is proved to be ambient isotopic to a smooth knot or link, so that both have the same type.

    Vertex j of the n of a component must be near γ(j/n).  False, which proves nothing, for a polygon that is too coarse
    or another curve.  Raises CurveError as `inscribed` does.
    """
    coefficients, power = scaled(coefficients)
    arcs = _apart(coefficients)
    if curve.dimension != 3 or len(curve.components) != len(arcs) or not all(curve.mesh.closed):
        return False
    return _follows(arcs, coefficients, curve, power)


def _apart(coefficients: Sequence[ComplexArray]) -> list[CurveArcs]:
    """The arcs of a link, which is proved to be embedded; CurveError otherwise."""
    arcs = [CurveArcs.of(c) for c in coefficients]
    if not _embedded(arcs):
        raise CurveError(_REFUSAL)
    return arcs


def _embedded(arcs: Sequence[CurveArcs]) -> bool:
    return all(cover(*pair) is not None for pair in combinations_with_replacement(arcs, 2))


def _follows(arcs: Sequence[CurveArcs], coefficients: Sequence[ComplexArray], polygon: Curve, power: int) -> bool:
    """Whether γ + τe, where e is how far 2ᵖ times the polygon is off, is embedded for all τ from 0 to 1."""
    with np.errstate(over="ignore"):
        parts = [np.ldexp(part, power) for part in polygon.components]
    if not all(np.isfinite(part).all() for part in parts):
        return False
    edges = map(_edges, coefficients, parts)
    return _embedded([replace(one, edges=its) for one, its in zip(arcs, edges, strict=True)])


def _edges(coefficients: ComplexArray, vertices: FloatArray) -> PolygonEdges:
    """How far vertices, and hence edges, are off the curve's points at equal steps."""
    high, low = points(coefficients, len(vertices))
    off = (vertices.T - high) - low
    sup, turn = (float(np.linalg.norm(a, axis=0).max()) for a in (off, off - np.roll(off, 1, axis=1)))
    rounding = 2.0**-40 * sup + 2.0**-90 * float(np.abs(coefficients).sum())
    return PolygonEdges(len(vertices), sup + rounding, len(vertices) * (turn + rounding))
