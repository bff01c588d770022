"""A binary tree of clusters of simplices, each of which from afar is its moments up to the second order."""

from dataclasses import dataclass

import numpy as np

from ...types import FloatArray, IntArray, frozen
from .multipoles import COLUMNS, ROWS, Multipoles
from .simplices import Potentials, Simplices


@dataclass(frozen=True, eq=False)
class Clusters:
    """Clusters of simplices, halved by their number across the longest way down to single ones.

    Attributes
    ----------
    simplices
        Sorted: the clusters are ranges.
    child
        The first of a cluster's two children, which are numbered one after the other; 0 for leaves.
    simplex
        The first simplex of each cluster, the only one of a leaf; shape (clusters,).
    centre
        Centroids c; shape (3, clusters).
    radius
        Of the smallest balls around the centroids that hold the clusters; shape (clusters,).
    size
        Areas or lengths W = ∫ dA; shape (clusters,).
    spread
        Second moments Q = ∫ (y − c)(y − c)ᵀ dA, as xx, yy, zz, xy, xz, yz; shape (6, clusters).
    """

    simplices: Simplices
    child: IntArray
    simplex: IntArray
    centre: FloatArray
    radius: FloatArray
    size: FloatArray
    spread: FloatArray

    @classmethod
    def of(cls, corners: FloatArray) -> "Clusters":
        """The tree of simplices with given corners, shape (corner, coordinate, simplex)."""
        order, start, stop, child, levels = _halved(np.mean(corners, axis=0))
        simplices = Simplices(frozen(np.ascontiguousarray(corners[:, :, order])))
        size, centre, spread = _moments(simplices, start, child, levels)
        radius = np.concatenate([_radii(simplices.corners, centre[:, s], start[s], stop[s]) for s in levels])
        return cls(simplices, *map(frozen, (child, start, centre, radius, size, spread)))

    def potential(self, index: IntArray, x: FloatArray) -> Potentials:
        """Φ of the clusters ``index``, shape (k,), each at its own points x, shape (3, k, points)."""
        return self._seen(index, x).potential()

    def change(self, index: IntArray, x: FloatArray, v: FloatArray) -> Potentials:
        """The derivatives of Φ and ∇Φ as the points move with velocities v, shape (3, k, points)."""
        return self._seen(index, x).change(v)

    def _seen(self, index: IntArray, x: FloatArray) -> Multipoles:
        strength = self.simplices.strength
        size, spread = strength * self.size[index, None], strength * self.spread[:, index, None]
        return Multipoles(self.simplices.exponent, x - self.centre[:, index, None], size, spread)


def _halved(points: FloatArray) -> tuple[IntArray, IntArray, IntArray, IntArray, list[slice]]:
    """An order of points, shape (3, f), and the ranges [start, stop), children and levels of the tree over it."""
    order = np.arange(points.shape[1])
    start, stop = np.array([0]), np.array([len(order)])
    parts, levels, first = [], [], 0
    while start.size:
        last = first + start.size
        levels.append(slice(first, last))
        split = stop - start > 1
        child = np.where(split, last + 2 * (np.cumsum(split) - 1), 0)
        parts.append((start, stop, child))
        start, stop = start[split], stop[split]
        _sort_across(points, order, start, stop)
        middle = (start + stop) // 2
        start, stop = (np.stack(ends, axis=1).ravel() for ends in ((start, middle), (middle, stop)))
        first = last
    starts, stops, children = (np.concatenate(arrays) for arrays in zip(*parts, strict=True))
    return order, starts, stops, children, levels


def _sort_across(points: FloatArray, order: IntArray, start: IntArray, stop: IntArray) -> None:
    """Sort each range of the order by the coordinate in which its points are spread the most."""
    if not start.size:
        return
    places = _places(start, stop)
    x = points[:, order[places]]
    first = np.cumsum(stop - start) - (stop - start)
    widths = np.maximum.reduceat(x, first, axis=1) - np.minimum.reduceat(x, first, axis=1)
    owner = np.repeat(np.arange(start.size), stop - start)
    along = x[np.argmax(widths, axis=0)[owner], np.arange(len(places))]
    order[places] = order[places][np.lexsort((along, owner))]


def _places(start: IntArray, stop: IntArray) -> IntArray:
    """The places of ranges, one after the other."""
    count = stop - start
    return np.asarray(np.repeat(start - np.cumsum(count) + count, count) + np.arange(count.sum()))


def _moments(
    simplices: Simplices, start: IntArray, child: IntArray, levels: list[slice]
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Sizes W, centroids c and second moments Q of all clusters, from the leaves up."""
    k = len(simplices.corners)
    size, centre = simplices.sizes[start], np.mean(simplices.corners, axis=0)[:, start]
    from_centre = simplices.corners[:, :, start] - centre
    spread = size / (k * (k + 1)) * np.sum(from_centre[:, ROWS] * from_centre[:, COLUMNS], axis=0)
    for level in reversed(levels):
        inner = level.start + np.flatnonzero(child[level])
        one, two = child[inner], child[inner] + 1
        size[inner] = size[one] + size[two]
        share = size[two] / size[inner]
        between = centre[:, two] - centre[:, one]
        centre[:, inner] = centre[:, one] + share * between
        apart = size[one] * share * between[ROWS] * between[COLUMNS]
        spread[:, inner] = spread[:, one] + spread[:, two] + apart
    return size, centre, spread


def _radii(corners: FloatArray, centre: FloatArray, start: IntArray, stop: IntArray) -> FloatArray:
    """Largest distance of a corner from the centre of its cluster, for the clusters of one level."""
    places, count = _places(start, stop), stop - start
    from_centre = corners[:, :, places] - np.repeat(centre, count, axis=1)
    square = np.max(np.einsum("cif,cif->cf", from_centre, from_centre), axis=0)
    return np.asarray(np.sqrt(np.maximum.reduceat(square, np.cumsum(count) - count)))
