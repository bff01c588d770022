"""The block list: all pairs of edges as pairs of distant clusters, and those too near as they are."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..clusters import ClusterTree, ranges
from ..curve import Curve, Mesh
from ..curve.tiles import EdgePairIndices
from ..errors import OptionError
from ..types import BoolArray, FloatArray, IntArray
from .clusters import balls, edge_clusters

ClusterPairs = tuple[IntArray, IntArray]

MOSTLY_NEAR = 1.0 / 8.0  # share of near pairs from which all pairs in tiles are faster than near ones in a list


@dataclass(frozen=True, eq=False)
class BlockList:
    """Every unordered pair of edges with disjoint closures exactly once: in a block, or by itself.

    A pair of clusters c, d is a block (is *admissible*) if r_c + r_d < θ |p_c − p_d|, for balls of centres p and radii
    r around their edges.  In a block, therefore, midpoints of edges are never nearer than (1/θ − 1)(ℓ_I + ℓ_J)/2: with
    θ ≤ 1/4 every pair that the barrier counts, |Δ| < 3/2 (ℓ_I + ℓ_J), is a near one.
    """

    mesh: Mesh  # connectivity
    tree: ClusterTree  # the clusters; all ranges are of positions in tree.order
    first: IntArray  # the two clusters of each block; shape (blocks,)
    second: IntArray
    leaves: ClusterPairs  # the pairs of leaves that are no blocks, two arrays; a leaf and itself are such a pair

    @classmethod
    def of(cls, curve: Curve, theta: float, leaf: int) -> "BlockList":
        """The list of a curve: separation parameter 0 < θ < 1, and the largest number of edges in a leaf."""
        tree = edge_clusters(curve, leaf)
        blocks, near = _traverse(tree, *balls(tree, curve), theta)
        return cls(curve.mesh, tree, *blocks, near)

    def is_separated(self, curve: Curve, theta: float) -> bool:
        """Whether another curve has the same mesh, and all blocks are admissible there with such a parameter."""
        if curve.mesh != self.mesh:
            return False
        return bool(_admissible(*balls(self.tree, curve), self.first, self.second, theta).all())

    @property
    def i(self) -> IntArray:
        """The first edge of each near pair, i < j, sorted by i and then by j; shape (pairs,)."""
        return self._edge_pairs[0]

    @property
    def j(self) -> IntArray:
        """The second edge; shape (pairs,)."""
        return self._edge_pairs[1]

    @cached_property
    def _edge_pairs(self) -> EdgePairIndices:
        return _edge_pairs(self.mesh, self.tree, self.leaves)

    @property
    def near_share(self) -> float:
        """How many of all pairs of edges are near ones, neighbours among them; they are not listed for that."""
        first, second = ((self.tree.stop - self.tree.start)[side] for side in self.leaves)
        count = float(np.where(self.leaves[0] == self.leaves[1], 0.5, 1.0) @ (first * second))
        return count / (0.5 * self.mesh.edges**2)

    @property
    def mostly_near(self) -> bool:
        """Whether all pairs are summed, one by one, because that is faster than the near ones from a list."""
        return self.near_share > MOSTLY_NEAR

    def near_pairs(self, without: EdgePairIndices | None = None) -> EdgePairIndices:
        """The near pairs but for some that are left out.

        Raises
        ------
        OptionError
            If one of these is not a near pair.
        """
        if without is None or not without[0].size:
            return self.i, self.j
        n = self.mesh.edges
        code, left_out = _code(self.i, self.j, n), np.unique(_code(*without, n))
        place = np.searchsorted(code, left_out)
        if not np.array_equal(code[place[place < len(code)]], left_out):
            raise OptionError("a pair of edges to be left out is not a near one")
        return np.delete(self.i, place), np.delete(self.j, place)

    @cached_property
    def middles(self) -> EdgePairIndices:
        """The middle edges of the two clusters of each block; shape (blocks,) twice."""
        order = self.tree.order
        return order[(self.a + self.b) // 2], order[(self.c + self.d) // 2]

    @cached_property
    def a(self) -> IntArray:
        """Where the first cluster's range [a, b) starts; shape (blocks,)."""
        return self.tree.start[self.first]

    @cached_property
    def b(self) -> IntArray:
        """Where it stops."""
        return self.tree.stop[self.first]

    @cached_property
    def c(self) -> IntArray:
        """Where the second cluster's range [c, d) starts; shape (blocks,)."""
        return self.tree.start[self.second]

    @cached_property
    def d(self) -> IntArray:
        """Where it stops."""
        return self.tree.stop[self.second]


def _traverse(
    tree: ClusterTree, centre: FloatArray, radius: FloatArray, theta: float
) -> tuple[ClusterPairs, ClusterPairs]:
    """Admissible pairs of clusters, and the pairs of leaves that remain (a leaf and itself among them)."""
    blocks: list[ClusterPairs] = []
    near: list[ClusterPairs] = []
    first = second = np.zeros(1, dtype=np.intp)
    while first.size:
        admissible = _admissible(centre, radius, first, second, theta)
        blocks.append((first[admissible], second[admissible]))
        first, second = first[~admissible], second[~admissible]
        done = tree.is_leaf[first] & tree.is_leaf[second]
        near.append((first[done], second[done]))
        first, second = _split(tree, radius, first[~done], second[~done])
    return _joined(blocks), _joined(near)


def _admissible(centre: FloatArray, radius: FloatArray, first: IntArray, second: IntArray, theta: float) -> BoolArray:
    d = centre[first] - centre[second]
    bound = radius[first] + radius[second]
    return np.asarray(bound * bound < theta**2 * np.einsum("ij,ij->i", d, d))


def _split(tree: ClusterTree, radius: FloatArray, first: IntArray, second: IntArray) -> ClusterPairs:
    """Pairs in which the children replace one of the two clusters, the larger one if it has any."""
    same = first == second
    diagonal = tree.child[first[same]]
    first, second = first[~same], second[~same]
    swap = tree.is_leaf[first] | (~tree.is_leaf[second] & (radius[first] < radius[second]))
    first, second = np.where(swap, second, first), np.where(swap, first, second)
    child = tree.child[first]
    return (
        np.concatenate([child, child + 1, diagonal, diagonal + 1, diagonal]),
        np.concatenate([second, second, diagonal, diagonal + 1, diagonal + 1]),
    )


def _edge_pairs(mesh: Mesh, tree: ClusterTree, leaves: ClusterPairs) -> EdgePairIndices:
    """All pairs of edges of two leaves that have no vertex in common, i < j, sorted by i and then by j."""
    row, begin, end = _without_neighbours(mesh, tree.order, *_rows(tree, leaves))
    count = np.maximum(end - begin, 0)
    i, j = tree.order[np.repeat(row, count)], tree.order[ranges(begin, count)]
    if np.any(np.diff(tree.order) < 0):
        i, j = np.divmod(np.sort(_code(i, j, mesh.edges)), mesh.edges)
    return i, j


def _rows(tree: ClusterTree, leaves: ClusterPairs) -> tuple[IntArray, IntArray, IntArray]:
    """For each position and each partner of its leaf the later positions [begin, end) there, sorted by both."""
    swap = tree.start[leaves[0]] > tree.start[leaves[1]]
    first, second = np.where(swap, leaves[::-1], leaves)
    by_start = np.argsort(tree.start[first] * len(tree.order) + tree.start[second])
    first, second = first[by_start], second[by_start]
    own = tree.leaves()  # each of which is a partner of its own
    partners = np.searchsorted(tree.start[first], [tree.start[own], tree.stop[own]])
    size = (tree.stop - tree.start)[own]
    start, count = np.repeat(partners[0], size), np.repeat(partners[1] - partners[0], size)
    row, partner = np.repeat(np.arange(len(tree.order)), count), second[ranges(start, count)]
    return row, np.maximum(tree.start[partner], row + 1), tree.stop[partner]


def _without_neighbours(
    mesh: Mesh, order: IntArray, row: IntArray, begin: IntArray, end: IntArray
) -> tuple[IntArray, IntArray, IntArray]:
    """The same ranges without the edges that share a vertex with the row's."""
    position = np.empty_like(order)
    position[order] = np.arange(len(order))
    # of two neighbours the later one comes right after, or is the last of the component whose first the other one is
    begin = begin + (begin == position[mesh.next[order]][row])
    last = position[mesh.previous[order]][row]
    cut = np.flatnonzero((begin <= last) & (last < end))
    return (
        np.insert(row, cut, row[cut]),
        np.insert(begin, cut + 1, last[cut] + 1),
        np.insert(end, cut, last[cut]),
    )


def _code(i: IntArray, j: IntArray, n: int) -> IntArray:
    """One number for each unordered pair, in the order of the near list."""
    return np.asarray(np.minimum(i, j) * n + np.maximum(i, j))


def _joined(parts: list[ClusterPairs]) -> ClusterPairs:
    return np.concatenate([first for first, _ in parts]), np.concatenate([second for _, second in parts])
