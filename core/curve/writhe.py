"""Writhe and average crossing number: crossings with and without signs, averaged over all directions of view."""

import numpy as np

from ..errors import CurveError
from ..types import FloatArray
from .curve import Curve

_ROWS = 64  # of edge pairs looked at together


def writhe_and_crossings(curve: Curve) -> tuple[float, float]:
    """Writhe and average crossing number of polygons in space, those between components included.

    Gauss's integral over a pair of edges is the area of the directions in which they are seen to cross, a spherical
    quadrilateral (Banchoff, *Indiana Univ. Math. J.* 25, 1976).

    Raises
    ------
    CurveError
        If the curve is not in space.
    """
    if curve.dimension != 3:
        raise CurveError(f"the curve has dimension {curve.dimension}; only curves in space have a writhe")
    writhe = crossings = 0.0
    for first in range(0, curve.mesh.edges, _ROWS):
        areas = _areas(curve, first)
        writhe += float(areas.sum())
        crossings += float(np.abs(areas).sum())
    return writhe / (2.0 * np.pi), crossings / (2.0 * np.pi)


def _areas(curve: Curve, first: int) -> FloatArray:
    """Signed areas for a block of edges with all later ones but their neighbours; shape (rows, edges − first).

    Each is that of two triangles between the directions of chords (van Oosterom and Strackee, *IEEE Trans. Biomed.
    Eng.* 30, 1983), whose triple products are equal.
    """
    mesh = curve.mesh
    tails, heads = curve.vertices[mesh.tails], curve.vertices[mesh.heads]
    i, j = slice(first, first + _ROWS), slice(first, None)
    a, b, d, c = (end[None, j] - start[i, None] for start in (tails, heads) for end in (tails, heads))
    volume = _dot(np.cross(curve.edge_vectors[None, j], curve.edge_vectors[i, None]), a)
    size = {name: np.sqrt(_dot(x, x)) for name, x in zip("abcd", (a, b, c, d), strict=True)}
    diagonal = _dot(a, c)
    area = np.zeros_like(volume)
    for x, name in ((b, "b"), (d, "d")):
        across = (size["a"] * size["c"] + diagonal) * size[name]
        area += 2.0 * np.arctan2(volume, across + _dot(a, x) * size["c"] + _dot(c, x) * size["a"])
    rows, columns = np.arange(mesh.edges)[i, None], np.arange(mesh.edges)[None, j]
    counted = (columns > rows) & mesh.disjoint(rows, columns)
    return np.asarray(np.where(counted, area, 0.0))


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("ijk,ijk->ij", a, b))
