"""Clusters of simplices: from afar each is its moments up to the second order."""

from dataclasses import dataclass

import numpy as np

from ...clusters import ClusterTree, ranges
from ...types import FloatArray, IntArray, frozen
from .simplices import Simplices, dot


@dataclass(frozen=True, eq=False)
class Clusters:
    """Clusters of simplices, halved by number across their longest extent down to single ones."""

    simplices: Simplices  # sorted: the clusters are ranges
    tree: ClusterTree  # its leaves are single simplices
    centre: FloatArray  # centroids c; shape (3, clusters)
    radius: FloatArray  # of the smallest balls around the centroids that hold the clusters; shape (clusters,)
    size: FloatArray  # areas or lengths W = ∫ dA; shape (clusters,)
    spread: FloatArray  # second moments Q = ∫ (y − c)(y − c)ᵀ dA; shape (3, 3, clusters)

    @classmethod
    def of(cls, corners: FloatArray) -> "Clusters":
        """The clusters of simplices with given corners, shape (corner, coordinate, simplex)."""
        points = np.mean(corners, axis=0)
        order = np.arange(points.shape[1])

        def cut(start: IntArray, stop: IntArray) -> IntArray:
            _sort_across(points, order, start, stop - start)
            return (start + stop) // 2

        tree = ClusterTree.halved(order, 1, cut)
        simplices = Simplices(frozen(np.ascontiguousarray(corners[:, :, order])))
        size, centre, spread = _moments(simplices, tree)
        radius = np.concatenate([_radii(simplices.corners, centre, tree, level) for level in tree.levels])
        return cls(simplices, tree, *map(frozen, (centre, radius, size, spread)))

    def potential(self, index: IntArray, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Φ and ∇Φ of the clusters ``index``, shape (k,), each at its own points x, shape (3, k, points).

        With K = 1/rᵖ and d = x − c

            Φ ≈ W K + ½ ⟨Q, ∇²K⟩ = r⁻ᵖ (W − p/2 tr Q/r² + p (p + 2)/2 dᵀQd/r⁴).
        """
        p, d = self.simplices.exponent, x - self.centre[:, index, None]
        q, half = self.spread[:, :, index, None], 0.5 * p * (p + 2)
        s = 1.0 / dot(d, d)
        kernel, q_d = self.simplices.strength * s ** (0.5 * p), q[:, 0] * d[0] + q[:, 1] * d[1] + q[:, 2] * d[2]
        size, trace, along = self.size[index, None], (q[0, 0] + q[1, 1] + q[2, 2]) * s, dot(d, q_d) * (s * s)
        radial = s * kernel * (half * trace - (p + 4) * half * along - p * size)
        return kernel * (size - 0.5 * p * trace + half * along), radial * d + (2.0 * half * s * s * kernel) * q_d


def _sort_across(points: FloatArray, order: IntArray, start: IntArray, count: IntArray) -> None:
    """Sort ranges of the order, each by the coordinate in which its points are spread the most."""
    if not start.size:
        return
    places = ranges(start, count)
    x = points[:, order[places]]
    first = np.cumsum(count) - count
    widths = np.maximum.reduceat(x, first, axis=1) - np.minimum.reduceat(x, first, axis=1)
    owner = np.repeat(np.arange(start.size), count)
    along = x[np.argmax(widths, axis=0)[owner], np.arange(len(places))]
    order[places] = order[places][np.lexsort((along, owner))]


def _moments(simplices: Simplices, tree: ClusterTree) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Sizes W, centroids c and second moments Q of all clusters, from the leaves up."""
    k = len(simplices.corners)
    size, centre = simplices.sizes[tree.start], np.mean(simplices.corners, axis=0)[:, tree.start]
    from_centre = simplices.corners[:, :, tree.start] - centre
    spread = size / (k * (k + 1)) * np.einsum("aif,ajf->ijf", from_centre, from_centre)
    for inner, child in tree.upward():
        size[inner] = size[child] + size[child + 1]
        share = size[child + 1] / size[inner]
        between = centre[:, child + 1] - centre[:, child]
        centre[:, inner] = centre[:, child] + share * between
        apart = size[child] * share * (between[:, None] * between)
        spread[:, :, inner] = spread[:, :, child] + spread[:, :, child + 1] + apart
    return size, centre, spread


def _radii(corners: FloatArray, centre: FloatArray, tree: ClusterTree, level: slice) -> FloatArray:
    """Largest distance of a corner from the centre of its cluster, for the clusters of one level."""
    count = (tree.stop - tree.start)[level]
    from_centre = corners[:, :, ranges(tree.start[level], count)] - np.repeat(centre[:, level], count, axis=1)
    square = np.max(np.einsum("cif,cif->cf", from_centre, from_centre), axis=0)
    return np.asarray(np.sqrt(np.maximum.reduceat(square, np.cumsum(count) - count)))
