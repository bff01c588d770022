"""Clusters of edges, and the block list: all pairs of edges, distant ones by pairs of clusters, near ones singly."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...base import BoolArray, FloatArray, IntArray, OptionError, dot
from ...curve import Curve, Mesh, component_order
from ..clusters import ClusterTree, ranges
from ..edge_pairs import EdgePairIndices

ClusterPairs = tuple[IntArray, IntArray]

MOSTLY_NEAR = 1.0 / 8.0  # share of near pairs from which all pairs in tiles are faster than near ones from a list


@dataclass(frozen=True, eq=False)
class BlockList:
    """Every unordered pair of edges with disjoint closures exactly once: in a block, or by itself.

    A pair of clusters c, d is a block (is *admissible*) if r_c + r_d < θ |p_c − p_d|, for balls of centers p and radii
    r around their edges.  In a block, therefore, midpoints of edges are never nearer than (1/θ − 1)(ℓ_I + ℓ_J)/2: with
    θ ≤ 1/4 every pair that the barrier counts, |Δ| < 3/2 (ℓ_I + ℓ_J), is a near one.
    """

    mesh: Mesh  # connectivity
    tree: ClusterTree  # the clusters; all ranges are of positions in tree.order
    first: IntArray  # the two clusters of each block; shape (blocks,)
    second: IntArray
    leaves: ClusterPairs  # the pairs of leaves that are not blocks, two arrays; a leaf and itself are such a pair

    @classmethod
    def of(cls, curve: Curve, theta: float, leaf: int) -> "BlockList":
        """The block list of a curve, for a separation parameter 0 < θ < 1 and a largest number of edges in a leaf."""
        tree = edge_clusters(curve, leaf)
        center, radius = balls(tree, curve)
        blocks, near = list[ClusterPairs](), list[ClusterPairs]()
        first = second = np.zeros(1, dtype=np.intp)
        while first.size:
            admissible = _admissible(center, radius, first, second, theta)
            blocks.append((first[admissible], second[admissible]))
            first, second = first[~admissible], second[~admissible]
            done = tree.is_leaf[first] & tree.is_leaf[second]
            near.append((first[done], second[done]))
            # children replace one of the two clusters, the larger one if it has any
            first, second = first[~done], second[~done]
            same = first == second
            diagonal = tree.child[first[same]]
            first, second = first[~same], second[~same]
            swap = tree.is_leaf[first] | (~tree.is_leaf[second] & (radius[first] < radius[second]))
            first, second = np.where(swap, second, first), np.where(swap, first, second)
            child = tree.child[first]
            first, second = (
                np.concatenate([child, child + 1, diagonal, diagonal + 1, diagonal]),
                np.concatenate([second, second, diagonal, diagonal + 1, diagonal + 1]),
            )
        first, second, *leaves = (np.concatenate(side) for each in (blocks, near) for side in zip(*each, strict=True))
        return cls(curve.mesh, tree, first, second, (leaves[0], leaves[1]))

    def is_separated(self, curve: Curve, theta: float) -> bool:
        """Whether another curve has the same mesh, and all blocks are admissible there with such a parameter."""
        if curve.mesh != self.mesh:
            return False
        return bool(_admissible(*balls(self.tree, curve), self.first, self.second, theta).all())

    @cached_property
    def near(self) -> EdgePairIndices:
        """The edges i < j of each near pair, sorted by i and then by j; shape (pairs,) twice."""
        size, codes, chunk = self.tree.stop - self.tree.start, [], 1 << 14  # pairs of leaves, to bound the memory
        for k in range(0, len(self.leaves[0]), chunk):
            first, second = (side[k : k + chunk] for side in self.leaves)
            count = size[first] * size[second]
            pair = np.repeat(np.arange(len(first)), count)
            row, column = np.divmod(ranges(np.zeros_like(count), count), size[second][pair])
            i = self.tree.order[self.tree.start[first][pair] + row]
            j = self.tree.order[self.tree.start[second][pair] + column]
            kept = self.mesh.disjoint(i, j) & ((first != second)[pair] | (i < j))
            codes.append(_code(i[kept], j[kept], self.mesh.edges))
        return np.divmod(np.sort(np.concatenate(codes)), self.mesh.edges)

    @property
    def mostly_near(self) -> bool:
        """Whether all pairs are summed one by one, because that is faster than near ones from a list."""
        first, second = ((self.tree.stop - self.tree.start)[side] for side in self.leaves)
        count = float(np.where(self.leaves[0] == self.leaves[1], 0.5, 1.0) @ (first * second))  # none is listed yet
        return count > MOSTLY_NEAR * 0.5 * self.mesh.edges**2

    def near_pairs(self, without: EdgePairIndices | None = None) -> EdgePairIndices:
        """The near pairs except some that are left out; OptionError if one of these is not a near pair."""
        if without is None or not without[0].size:
            return self.near
        (i, j), n = self.near, self.mesh.edges
        code, left_out = _code(i, j, n), np.unique(_code(*without, n))
        place = np.searchsorted(code, left_out)
        if not np.array_equal(code[place[place < len(code)]], left_out):
            raise OptionError("a pair of edges to be left out is not a near one")
        return np.delete(i, place), np.delete(j, place)

    @cached_property
    def middles(self) -> EdgePairIndices:
        """The middle edges of the two clusters of each block; shape (blocks,) twice."""
        a, b, c, d = self.ranges
        return self.tree.order[(a + b) // 2], self.tree.order[(c + d) // 2]

    @cached_property
    def ranges(self) -> IntArray:
        """Where the ranges [a, b) and [c, d) of the two clusters of each block start and stop; shape (4, blocks)."""
        start, stop = self.tree.start, self.tree.stop
        return np.stack([start[self.first], stop[self.first], start[self.second], stop[self.second]])


def _admissible(center: FloatArray, radius: FloatArray, first: IntArray, second: IntArray, theta: float) -> BoolArray:
    d = center[first] - center[second]
    bound = radius[first] + radius[second]
    return np.asarray(bound * bound < theta**2 * dot(d, d))


def _code(i: IntArray, j: IntArray, n: int) -> IntArray:
    """One number for each unordered pair, in the order of the near list."""
    return np.asarray(np.minimum(i, j) * n + np.maximum(i, j))


def edge_clusters(curve: Curve, leaf: int) -> ClusterTree:
    """The tree of a curve's edges whose leaves have at most ``leaf`` of them; leaf ≥ 1.

    The order follows the curve, one component after the other; only their succession is changed where there are three
    or more, so that neighbours in space come next to each other.  A cluster is a part of one component, or several
    whole ones: however many small components there are, the tree of n edges has O(n) clusters and O(log n) levels.
    """
    order = component_order(curve.mesh, curve.vertices.T)
    ends = np.append(np.flatnonzero(np.diff(curve.mesh.edge_component[order])) + 1, curve.mesh.edges)

    def cut(start: IntArray, stop: IntArray) -> IntArray:
        """Between two components if ranges hold more than one, else in the middle."""
        middle = (start + stop) // 2
        after = np.searchsorted(ends, middle)
        before = ends[np.maximum(after - 1, 0)]
        nearer = (ends[after] >= stop) | (2 * middle < before + ends[after])
        between = np.where((before > start) & nearer, before, ends[after])
        return np.where((between > start) & (between < stop), between, middle)

    return ClusterTree.halved(order, leaf, cut)


def balls(tree: ClusterTree, curve: Curve) -> tuple[FloatArray, FloatArray]:
    """Centres, shape (clusters, m), and radii, shape (clusters,), of balls around the clusters' bounding boxes."""
    ends = curve.vertices[curve.mesh.tails[tree.order]], curve.vertices[curve.mesh.heads[tree.order]]
    low = tree.reduced(np.minimum, np.minimum(*ends))
    high = tree.reduced(np.maximum, np.maximum(*ends))
    diagonal = high - low
    return 0.5 * (low + high), 0.5 * np.sqrt(dot(diagonal, diagonal))
