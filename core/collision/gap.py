"""Distances between edges that are not neighbours, folds of neighbours, and the resulting thickness."""

from collections.abc import Callable, Iterator
from itertools import chain

import numpy as np

from ..base import MIN_GAP, CurveError, FloatArray, IntArray, Message, Place, column_dot, dot
from ..curve import Curve, Mesh, arc_distance_of_points, bending_radii
from .boxes import BoxTree, corners, nearer_than
from .planes import closest_chord, relative_motion


def minimal_gap(curve: Curve) -> tuple[float, tuple[int, int] | None]:
    """Return the smallest distance between two non-neighbour edges, and one pair of edges that has it.

    A floating-point value, accurate to rounding: 0 or a tiny number if edges meet. A single triangle, or an arc of two
    edges, has no such pair: infinity and None.
    """
    points, unit = scaled_points(curve)
    best, pair, mesh = np.inf, None, curve.mesh
    farthest = 4.0 * len(points)  # for coordinates within ±1; finite, since the boxes' padding is infinitely far
    i, j = np.arange(mesh.edges), mesh.next[mesh.next]
    apart = (j != mesh.next) & (mesh.next[j] != i)  # a triangle has no edges one edge apart, nor has the end of an arc
    i, j = i[apart], j[apart]
    begin = i, j, squared_segment_distances(points, corners(mesh, i, j))
    others = near_edges(curve, points, lambda: min(best, farthest))
    for i, j, squares in chain([begin], others):
        if i.size and squares.min() < best:
            k = int(np.argmin(squares))
            best, pair = float(squares[k]), (int(i[k]), int(j[k]))
    return float(np.ldexp(np.sqrt(best), unit)), pair


def check_gap(curve: Curve) -> None:
    """Refuse strands so near that the energy of their edges consists of rounding errors.

    The CurveError says where.  Edges of which only the ends are near, with a short edge between them or a vertex that
    nearly lies on an edge, do no harm.
    """
    points, unit = scaled_points(curve)
    radius = float(np.ldexp(MIN_GAP * curve.length, -unit))
    for i, j, squares in near_edges(curve, points, lambda: radius**2):
        apart = np.linalg.norm(curve.midpoints[i] - curve.midpoints[j], axis=1)
        # midpoints further apart than that part of the longer edge do not feel that edges are near
        near = apart <= 1e-3 * np.maximum(curve.edge_lengths[i], curve.edge_lengths[j])
        if near.any():
            k = int(np.where(near, squares, np.inf).argmin())
            point = curve.vertices[curve.mesh.tails[i[k]]]
            gap = float(np.ldexp(np.sqrt(squares[k]), unit))
            sentence = (
                "strands are only {gap:.2g} apart near {place}, less than {least:g} of the curve's length: too close "
                "to compute their energy; move them apart"
            )
            message = Message(sentence, gap=gap, place=written(point), least=MIN_GAP)
            raise CurveError(message, Place((), tuple(point.tolist())))


def thickness(curve: Curve, most: float = np.inf) -> float:
    """Thickness: the radius of the thickest tube around a polygon that neither kinks nor touches itself, or ``most``.

    The smaller of two numbers (Rawdon, *Experimental Mathematics* 12, 2003): the least bending radius, and half the
    least distance of points that are further apart along the curve than half a circle of that radius is long.
    Ropelength is the length divided by the thickness.
    """
    bend, (points, unit) = float(bending_radii(curve).min()), scaled_points(curve)
    best = min(float(np.ldexp(2.0 * min(bend, most), -unit)) ** 2, 4.0 * len(points))  # for coordinates within ±1
    mesh, ell, tree = curve.mesh, curve.edge_lengths, BoxTree.build(curve.mesh, points)
    near = tree.pairs(nearer_than(lambda: best))
    for a, b in near:
        # Points just half a circle apart are two radii apart or more (Schur's theorem).  So where the closest points of
        # two edges are nearer along the curve, none of the others can count for less than the bending radius.
        i, j = tree.order[a], tree.order[b]
        half = 0.5 * ell[i], 0.5 * ell[j]
        far = arc_distance_of_points(curve, i, half[0], j, half[1]) + half[0] + half[1] >= np.pi * bend
        i, j = i[far], j[far]
        # the closest points, as lengths from the edges' tails; one of many pairs if they are parallel
        e, f = curve.edge_vectors[i] / ell[i, None], curve.edge_vectors[j] / ell[j, None]
        D = curve.vertices[mesh.tails[i]] - curve.vertices[mesh.tails[j]]
        ef, De, Df = (np.einsum("pm,pm->p", *pair) for pair in ((e, f), (D, e), (D, f)))
        s = ((ef * Df - De) / np.maximum(1.0 - ef * ef, np.finfo(np.float64).eps)).clip(0.0, ell[i])
        t = (ef * s + Df).clip(0.0, ell[j])
        s = (ef * t - De).clip(0.0, ell[i])
        chord = np.ldexp(D + s[:, None] * e - t[:, None] * f, -unit)
        squares = dot(chord, chord)[arc_distance_of_points(curve, i, s, j, t) >= np.pi * bend]
        best = min(best, float(squares.min(initial=np.inf)))
    return min(bend, most, 0.5 * float(np.ldexp(np.sqrt(best), unit)))


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
    tree = BoxTree.build(curve.mesh, points)
    for a, b in tree.pairs(nearer_than(bound)):
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
    return column_dot(chord, chord)


def written(position: FloatArray) -> str:
    """A point as messages write it."""
    return "(" + ", ".join(f"{x:.6g}" for x in position) + ")"


def folds(mesh: Mesh) -> IntArray:
    """Vertices and the segments that they must not lie on, as the ends x₀ = x₁ and y₀, y₁; shape (4, folds).

    When two neighbour edges fold onto each other, or one shrinks to a point, an end of one lies on the other, and the
    edge that begins there meets this one, which is no neighbour of it, but for two cases: in a triangle it is the
    neighbour on the other side, and at the end of an arc there is none.  So a polygon is embedded if no two
    non-neighbour edges meet, no vertex of a triangle lies on the opposite edge, and no end of an arc lies on the edge
    after its neighbour, or, if that is the other end, on that.  Segments begin at the tails of their edges.
    """
    triangles = mesh.offsets[:-1][np.asarray(mesh.closed) & (np.asarray(mesh.component_sizes) == 3)]
    after, before = mesh.heads[mesh.outgoing], mesh.tails[mesh.incoming]
    first, last = mesh.ends.T
    u = np.concatenate([triangles, triangles + 1, triangles + 2, first])
    forward = np.stack([u, u, after[u], after[after[u]]])
    backward = np.stack([last, last, before[before[last]], before[last]])
    return np.concatenate([forward, backward], axis=1)
