"""Distances between points of a polygon, in space and along the curve, and between its strands."""

import numpy as np
from scipy.spatial import cKDTree

from ..base import TINY, FloatArray, IntArray, dot
from .curve import Curve

STRAND_RATIO = 2.0  # points are on different strands if their distance along the curve is this many times their gap


def points_at(curve: Curve, t: float) -> FloatArray:
    """The point at parameter t ∈ [0, 1] of every edge; shape (edges, m)."""
    return (1.0 - t) * curve.vertices[curve.mesh.tails] + t * curve.vertices[curve.mesh.heads]


def arc_positions(curve: Curve, t: float) -> FloatArray:
    """Arc length from its component's first vertex to the point at parameter t of every edge; shape (edges,)."""
    return np.asarray(curve.arc_starts + t * curve.edge_lengths)


def vertex_positions(curve: Curve) -> FloatArray:
    """Arc length from its component's first vertex to every vertex; shape (n,)."""
    mesh, last = curve.mesh, curve.mesh.ends[:, 1]
    position = mesh.at_tails(curve.arc_starts)
    position[last] = curve.component_lengths[mesh.component[last]]
    return position


def periods(curve: Curve) -> FloatArray:
    """Length once round each component, infinite if it is open; shape (components,)."""
    return np.where(curve.mesh.closed, curve.component_lengths, np.inf)


def points_along(curve: Curve, component: IntArray, position: FloatArray) -> FloatArray:
    """The points of components at arc lengths from their first vertices, taken modulo the periods; shape (k, m)."""
    mesh, ell = curve.mesh, curve.edge_lengths
    ends = np.cumsum(ell)
    starts = np.concatenate([[0.0], ends])[mesh.edge_offsets]
    round_ = np.asarray(mesh.closed)[component]
    along = starts[component] + np.where(round_, position % np.diff(starts)[component], position)
    edge = np.minimum(np.searchsorted(ends, along, side="right"), mesh.edge_offsets[component + 1] - 1)
    t = 1.0 - ((ends[edge] - along) / np.maximum(ell[edge], TINY)).clip(0.0, 1.0)
    return np.asarray(curve.vertices[mesh.tails[edge]] + t[:, None] * curve.edge_vectors[edge])


def nearest_on_edges(curve: Curve, edges: IntArray, points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Where edges, (k,), are nearest to points, (k, m) or (m,), as shares of their lengths, and how far that is."""
    e, chord = curve.edge_vectors[edges], points - curve.vertices[curve.mesh.tails[edges]]
    t = (dot(chord, e) / np.maximum(curve.edge_lengths[edges] ** 2, TINY)).clip(0.0, 1.0)
    return t, np.asarray(np.linalg.norm(chord - t[:, None] * e, axis=1))


def arc_distances(curve: Curve, t_i: float, t_j: float, rows: IntArray, columns: slice) -> FloatArray:
    """ϱ between points at t_i and t_j of edges given by tails; inf across components, any number at arcs' ends."""
    mesh, component = curve.mesh, curve.mesh.component
    start, end = (mesh.at_tails(arc_positions(curve, t)) for t in (t_i, t_j))
    distance = np.subtract.outer(start[rows], end[columns])
    np.abs(distance, out=distance)
    np.minimum(distance, periods(curve)[component[rows], None] - distance, out=distance)
    if len(mesh.closed) > 1:
        distance[component[rows, None] != component[columns]] = np.inf
    return distance


def arc_distance_of_pairs(curve: Curve, i: IntArray, j: IntArray, t: float = 0.0) -> FloatArray:
    """ϱ between the points at t of edges ``i`` and ``j``, by default their tails; inf across components."""
    return arc_distance_of_points(curve, i, t * curve.edge_lengths[i], j, t * curve.edge_lengths[j])


def arc_distance_of_points(curve: Curve, i: IntArray, s: FloatArray, j: IntArray, t: FloatArray) -> FloatArray:
    """ϱ between points at lengths s from the tails of edges ``i`` and t from those of ``j``; inf across components."""
    start, component = curve.arc_starts, curve.mesh.edge_component
    return _shorter_way(curve, component[i], component[j], np.abs(start[i] + s - start[j] - t))


def arc_distance_of_vertices(curve: Curve, i: IntArray, j: IntArray) -> FloatArray:
    """ϱ between vertices ``i`` and ``j``, elementwise; inf across components."""
    position, component = vertex_positions(curve), curve.mesh.component
    return _shorter_way(curve, component[i], component[j], np.abs(position[i] - position[j]))


def _shorter_way(curve: Curve, c: IntArray, d: IntArray, gap: FloatArray) -> FloatArray:
    """ϱ between points of components c and d, from the difference of their arc lengths."""
    lengths = np.add.reduceat(curve.edge_lengths, curve.mesh.edge_offsets[:-1])
    other_way = np.where(curve.mesh.closed, lengths, np.inf)[c] - gap
    return np.where(c == d, np.minimum(gap, other_way), np.inf)


def nearest_strands(curve: Curve, ratio: float, furthest: float = np.inf) -> float:
    """Least distance between vertices of different strands, inf if it is more than ``furthest``.

    Two vertices lie on different strands if they are more than ``ratio`` times further apart along the curve than in
    space, or on different components.  The radius of search doubles until it finds some: all pairs within the furthest
    would be too many where a long curve is tightly wound, as there the nearest strands are much nearer.
    """
    tree = cKDTree(curve.vertices)
    furthest = min(furthest, float(np.linalg.norm(np.ptp(curve.vertices, axis=0))))
    radius = curve.length / len(curve)
    while True:
        radius = min(2.0 * radius, furthest)
        i, j = tree.query_pairs(radius, output_type="ndarray").T
        distance = np.linalg.norm(curve.vertices[i] - curve.vertices[j], axis=1)
        distance = distance[arc_distance_of_vertices(curve, i, j) > ratio * distance]
        if distance.size:
            return float(distance.min())
        if radius >= furthest:
            return np.inf


def strand_gaps(curve: Curve, radius: float) -> FloatArray:
    """Distance from each vertex to the nearest one on another strand, inf beyond ``radius``; shape (n,).

    Sides of a corner are no strands: however sharp, it looks the same at every scale, so that shorter edges do not
    bring neighbours nearer than its sides.
    """
    tree = cKDTree(curve.vertices)
    pairs = tree.query_pairs(radius, output_type="ndarray")
    i, j = np.concatenate([pairs, pairs[:, ::-1]]).T  # seen from either end
    mesh, positions = curve.mesh, vertex_positions(curve)
    neighbours = j, mesh.heads[mesh.outgoing[j]], mesh.tails[mesh.incoming[j]]
    distance, after, before = (np.linalg.norm(curve.vertices[i] - curve.vertices[k], axis=1) for k in neighbours)
    passing = (distance <= after) & (distance <= before)
    passing &= arc_distance_of_vertices(curve, i, j) > STRAND_RATIO * distance
    i, j, distance = i[passing], j[passing], distance[passing]
    # arc lengths to the points nearest to vertices i on the edges that meet at vertices j
    found = []
    for edge in (mesh.outgoing[j], mesh.incoming[j]):
        ell, (t, away) = curve.edge_lengths[edge], nearest_on_edges(curve, edge, curve.vertices[i])
        found.append((away, positions[j] - np.where(mesh.tails[edge] == j, 0.0, ell) + t * ell))
    (after, ahead), (before, behind) = found
    start, end = positions[i], np.asarray(np.where(after < before, ahead, behind))
    component = mesh.component[i]
    closed, length = np.asarray(mesh.closed)[component], curve.component_lengths[component]

    def apart(arc: FloatArray, fraction: float) -> FloatArray:
        """The distance between the ends of the arc's middle part."""
        ends = [points_along(curve, component, start + 0.5 * (1.0 + s * fraction) * arc) for s in (-1, 1)]
        return np.asarray(np.linalg.norm(ends[1] - ends[0], axis=1))

    forward = np.where(closed, (end - start) % length, end - start)
    other_way = np.where(closed, forward - length, forward)
    # strands that close in on each other: four times nearer to a corner its sides do
    closing = [apart(arc, 0.25) < 0.6 * apart(arc, 1.0) for arc in (forward, other_way)]
    strands = (component != mesh.component[j]) | ~(closing[0] | closing[1])
    gaps = np.full(len(curve), np.inf)
    np.minimum.at(gaps, i[strands], distance[strands])
    return gaps


def near_by_octave(points: FloatArray, sizes: FloatArray, reach: float) -> tuple[IntArray, IntArray, FloatArray]:
    """Pairs of a larger and a smaller point and their distances, below ``reach`` times the largest size of the octave.

    A k-d tree per octave of sizes keeps them few when sizes differ a lot.  Within an octave a pair is found twice.
    """
    octave, found = np.frexp(sizes)[1], []
    for level in np.unique(octave):
        large, small = np.flatnonzero(octave == level), np.flatnonzero(octave <= level)
        tree, others = cKDTree(points[large]), cKDTree(points[small])
        near = tree.sparse_distance_matrix(others, reach * float(sizes[large].max()), output_type="ndarray")
        found.append((large[near["i"]], small[near["j"]], near["v"]))
    i, j, distance = (np.concatenate(each) for each in zip(*found, strict=True))
    return i, j, distance
