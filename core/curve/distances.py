"""Distances between points of a polygon, in space and along the curve."""

import numpy as np

from ..types import FloatArray, IntArray
from .curve import Curve


def points_at(curve: Curve, t: float) -> FloatArray:
    """The point at parameter t ∈ [0, 1] of every edge; shape (n, m)."""
    return (1.0 - t) * curve.vertices[curve.mesh.tails] + t * curve.vertices[curve.mesh.heads]


def squared_distances(x: FloatArray, y: FloatArray) -> FloatArray:
    """|x_i − y_j|² for all i, j; differences first, so that near points far from the origin stay exact."""
    total = np.zeros((len(x), len(y)))
    scratch = np.empty_like(total)
    for k in range(x.shape[1]):
        np.subtract.outer(x[:, k], y[:, k], out=scratch)
        scratch *= scratch
        total += scratch
    return total


def arc_positions(curve: Curve, t: float) -> FloatArray:
    """Arc length from its component's first vertex to the point at parameter t of every edge; shape (n,)."""
    ell = curve.edge_lengths
    position = np.concatenate([np.cumsum(ell[s]) - ell[s] for s in curve.mesh.slices])
    return np.asarray(position + t * ell)


def points_along(curve: Curve, component: IntArray, position: FloatArray) -> FloatArray:
    """The points of components at arc lengths from their first vertices, taken modulo the length; shape (k, m)."""
    ends = np.cumsum(curve.edge_lengths)
    starts = np.concatenate([[0.0], ends])[curve.mesh.offsets]
    along = starts[component] + position % np.diff(starts)[component]
    edge = np.minimum(np.searchsorted(ends, along, side="right"), curve.mesh.offsets[component + 1] - 1)
    t = 1.0 - ((ends[edge] - along) / np.maximum(curve.edge_lengths[edge], np.finfo(np.float64).tiny)).clip(0.0, 1.0)
    return np.asarray(curve.vertices[edge] + t[:, None] * curve.edge_vectors[edge])


def arc_distance_of_pairs(curve: Curve, i: IntArray, j: IntArray, t_i: float = 0.0, t_j: float = 0.0) -> FloatArray:
    """ϱ between the points at ``t_i`` of edges ``i`` and at ``t_j`` of edges ``j``, broadcast; inf across components.

    By default the points are the edges' tails, the vertices of the same numbers.
    """
    lengths = np.array([curve.edge_lengths[s].sum() for s in curve.mesh.slices])
    component = curve.mesh.component
    gap = np.abs(arc_positions(curve, t_i)[i] - arc_positions(curve, t_j)[j])
    distance = np.minimum(gap, lengths[component[i]] - gap)
    if len(lengths) > 1:
        distance[component[i] != component[j]] = np.inf
    return np.asarray(distance)
