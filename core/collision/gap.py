"""Distances between edges that are no neighbours: the smallest one, and those too small to compute with."""

from collections.abc import Callable, Iterator

import numpy as np

from ..curve import Curve
from ..errors import CurveError, Place
from ..messages import Message
from ..types import BoolArray, FloatArray, IntArray
from .boxes import BoxTree, Level, corners
from .chords import closest_chord
from .planes import relative_motion

MIN_GAP = 1e-11  # relative to the curve's length; at half of that, energies are wrong by percents
ENDS_ONLY = 1e-3  # of the longer edge: midpoints further apart than that don't feel that the edges are near


def minimal_gap(curve: Curve) -> tuple[float, tuple[int, int] | None]:
    """Return the smallest distance between two non-neighbour edges, and one pair of edges that has it.

    A floating-point value, accurate to rounding: 0 or a tiny number if edges meet. A single triangle, or an arc of two
    edges, has no such pair: infinity and None.
    """
    points, unit = scaled_points(curve)
    best, pair = _some_gap(curve, points)
    farthest = 4.0 * len(points)  # of coordinates within ±1; finite, since the boxes' padding is infinitely far

    def bound() -> float:
        return min(best, farthest)

    for i, j, squares in near_edges(curve, points, bound):
        if i.size and squares.min() < best:
            k = int(np.argmin(squares))
            best, pair = float(squares[k]), (int(i[k]), int(j[k]))
    return float(np.ldexp(np.sqrt(best), unit)), pair


def check_gap(curve: Curve) -> None:
    """Refuse strands so near that the energy of their edges is nothing but rounding errors.

    Edges of which only the ends are near, with a short edge between them or a vertex that nearly lies on an edge, do
    no harm.

    Raises
    ------
    CurveError
        One sentence that says where.
    """
    points, unit = scaled_points(curve)
    radius = float(np.ldexp(MIN_GAP * curve.length, -unit))
    for i, j, squares in near_edges(curve, points, lambda: radius**2):
        apart = np.linalg.norm(curve.midpoints[i] - curve.midpoints[j], axis=1)
        near = apart <= ENDS_ONLY * np.maximum(curve.edge_lengths[i], curve.edge_lengths[j])
        if near.any():
            k = int(np.where(near, squares, np.inf).argmin())
            point = curve.vertices[curve.mesh.tails[i[k]]]
            gap, place = np.ldexp(np.sqrt(squares[k]), unit), ", ".join(f"{x:.6g}" for x in point)
            near = (
                "strands are only {gap:.2g} apart near ({place}), less than {least:g} of the curve's length: too close "
                "to compute their energy; move them apart"
            )
            raise CurveError(
                Message(near, gap=float(gap), place=place, least=MIN_GAP), Place((), tuple(point.tolist()))
            )


def scaled_points(curve: Curve) -> tuple[FloatArray, int]:
    """The vertices divided by a power of two so that all coordinates are within ±1, shape (m, n), and its exponent."""
    unit = int(np.frexp(np.abs(curve.vertices).max())[1])
    return np.ldexp(curve.vertices.T, -unit, order="C"), unit


def near_edges(
    curve: Curve, points: FloatArray, bound: Callable[[], float]
) -> Iterator[tuple[IntArray, IntArray, FloatArray]]:
    """Yield the pairs of non-neighbour edges whose squared distance is at most ``bound()``, batch by batch.

    Two arrays of edges and one of squared distances; ``bound`` may fall meanwhile.  ``points`` are the vertices as
    `scaled_points` gives them.
    """
    tree = BoxTree.build(curve.mesh, points, points)

    def near(level: Level, a: IntArray, other: Level, b: IntArray) -> BoolArray:
        return squared_gaps(level.gaps(a, other, b)) <= bound()

    for a, b in tree.pairs(near):
        i, j = tree.order[a], tree.order[b]
        squares = squared_segment_distances(points, np.concatenate([tree.corners[:, a], tree.corners[:, b]]))
        kept = squares <= bound()
        yield i[kept], j[kept], squares[kept]


def squared_segment_distances(points: FloatArray, vertices: IntArray) -> FloatArray:
    """Squared distances of pairs of segments given by their end points; shapes (m, n), (4, pairs) -> (pairs,)."""
    motion = relative_motion(points, points, vertices)[0]
    if len(points) > 3:  # four points span three dimensions at most: the same vectors in coordinates of their span
        motion = np.asarray(np.linalg.qr(motion.transpose(2, 1, 0), mode="r")).transpose(2, 1, 0)
    chord = closest_chord(motion)
    return np.asarray(np.einsum("mp,mp->p", chord, chord))


def squared_gaps(signed: FloatArray) -> FloatArray:
    """Squared distances of boxes at the first time, from their signed gaps along ±each axis.

    Boxes are never further apart than those in them, to the last bit: gaps are not larger, and each product and sum is
    rounded monotonically, in the same order for all pairs.
    """
    return np.asarray(sum(gap * gap for gap in np.maximum(signed[0], 0.0)))


def _some_gap(curve: Curve, points: FloatArray) -> tuple[float, tuple[int, int] | None]:
    """A squared gap to begin with: the smallest one between edges one edge apart, and these; infinite without any."""
    mesh = curve.mesh
    i, j = np.arange(mesh.edges), mesh.next[mesh.next]
    apart = (j != mesh.next) & (mesh.next[j] != i)  # a triangle has no such edges, nor has the end of an arc
    i, j = i[apart], j[apart]
    if not i.size:
        return np.inf, None
    squares = squared_segment_distances(points, corners(mesh, i, j))
    k = int(np.argmin(squares))
    return float(squares[k]), (int(i[k]), int(j[k]))
