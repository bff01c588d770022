"""The smallest distance between edges that are no neighbours."""

import numpy as np

from ..curve import Curve
from ..types import BoolArray, FloatArray, IntArray
from .boxes import BoxTree, Level
from .planes import closest_chord, relative_motion


def minimal_gap(curve: Curve) -> tuple[float, tuple[int, int] | None]:
    """Return the smallest distance between two non-neighbour edges, and one pair of edges that has it.

    A floating-point value, accurate to rounding: 0 or a tiny number if edges meet. A single triangle has no such
    pair: infinity and None.

    Raises
    ------
    ValueError
        If the curve is neither in the plane nor in space.
    """
    if curve.dimension > 3:
        raise ValueError(f"the curve has dimension {curve.dimension}; gaps are measured in 2 and 3 dimensions")
    unit = int(np.frexp(np.abs(curve.vertices).max())[1])
    points = np.ldexp(curve.vertices.T, -unit, order="C")
    tree = BoxTree.build(curve.mesh, points, points)
    best, pair = _some_gap(curve, points)

    def near(level: Level, a: IntArray, b: IntArray) -> BoolArray:
        return _squared_gaps(level, a, b) <= min(best, 4.0 * len(points))  # beyond the padding, which is infinitely far

    tails, heads = tree.order, curve.mesh.heads[tree.order]
    for a, b in tree.pairs(near):
        if not a.size:
            continue
        squares = squared_distances(points, np.stack([tails[a], heads[a], tails[b], heads[b]]))
        k = int(np.argmin(squares))
        if squares[k] < best:
            best, pair = float(squares[k]), (int(tails[a[k]]), int(tails[b[k]]))
    return float(np.ldexp(np.sqrt(best), unit)), pair


def squared_distances(points: FloatArray, vertices: IntArray) -> FloatArray:
    """Squared distances of pairs of segments given by their end points; shapes (m, n), (4, pairs) -> (pairs,)."""
    chord = closest_chord(relative_motion(points, points, vertices)[0])
    return np.asarray(np.einsum("mp,mp->p", chord, chord))


def _squared_gaps(level: Level, a: IntArray, b: IntArray) -> FloatArray:
    gaps = np.maximum(level.gaps(a, b)[0], 0.0)
    return np.asarray(np.einsum("kp,kp->p", gaps, gaps))


def _some_gap(curve: Curve, points: FloatArray) -> tuple[float, tuple[int, int] | None]:
    """A squared gap to begin with: the smallest one between edges one edge apart, and these; infinite without any."""
    mesh = curve.mesh
    heads = mesh.heads
    i, j = mesh.tails, heads[heads]
    apart = heads[j] != i  # a triangle has no such edges
    i, j = i[apart], j[apart]
    if not i.size:
        return np.inf, None
    squares = squared_distances(points, np.stack([i, heads[i], j, heads[j]]))
    k = int(np.argmin(squares))
    return float(squares[k]), (int(i[k]), int(j[k]))
