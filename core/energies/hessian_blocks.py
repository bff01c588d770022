"""Assembly of a dense second derivative from the blocks of pairs of edges.

A function of pairs of edges depends on the vertices through e_I = P(I↑) − P(I↓) and c_I = P(I↑) + P(I↓), so
∂P(I↑) = ∂c_I + ∂e_I and ∂P(I↓) = ∂c_I − ∂e_I.
"""

from typing import NamedTuple

import numpy as np

from ..curve import Curve, Mesh
from ..curve.tiles import Tile
from ..types import FloatArray, IntArray


class OwnBlocks(NamedTuple):
    """Second derivatives by one edge's own e and c, summed over its partners; each of shape (edges, m, m)."""

    ee: FloatArray
    ec: FloatArray
    cc: FloatArray

    @classmethod
    def zeros(cls, edges: int, m: int) -> "OwnBlocks":
        return cls(*(np.zeros((edges, m, m)) for _ in range(3)))

    def add_to(self, matrix: FloatArray, mesh: Mesh, factor: float) -> None:
        """Add ``factor`` times the blocks to a matrix of shape (n, m, n, m)."""
        even = factor * (self.ec + self.ec.transpose(0, 2, 1))
        odd = factor * (self.ec - self.ec.transpose(0, 2, 1))
        same, other = factor * (self.cc + self.ee), factor * (self.cc - self.ee)
        t, h = mesh.tails, mesh.heads
        # no vertex is the tail of two edges or the head of two, so no index repeats within a statement
        matrix[h, :, h, :] += same + even
        matrix[t, :, t, :] += same - even
        matrix[h, :, t, :] += other + odd
        matrix[t, :, h, :] += other - odd


class CouplingPlanes:
    """Blocks that couple two edges I ≠ J, collected as one (n, n) plane for each two coordinates.

    Pairs are given once; `symmetric_matrix` adds the transposed blocks.  In the planes the tail of edge I has the
    number I, and vertices where arcs end come last, so that blocks of edges are blocks of the planes.
    """

    def __init__(self, curve: Curve) -> None:
        n, m = curve.vertices.shape
        self.mesh = curve.mesh
        self.planes = np.zeros((m, m, n, n))
        self._numbers = np.empty(n, dtype=np.intp)
        self._numbers[np.concatenate([curve.mesh.tails, curve.mesh.ends[:, 1]])] = np.arange(n)
        self._heads = self._numbers[curve.mesh.heads]

    def add(self, k: int, j: int, tile: Tile, ee: FloatArray, ec: FloatArray, fc: FloatArray, cc: FloatArray) -> None:
        """Add the entries for coordinate k of edge I (rows) and coordinate j of edge J (columns) of a tile.

        For a function of e_I, e_J and Δ = (c_I − c_J)/2 they are, all of shape (rows, columns), the derivatives
        ∂e_I ∂e_J, ∂e_I ∂Δ/2, ∂Δ/2 ∂e_J and ∂Δ/2 ∂Δ/2.  They are overwritten.
        """
        rows = tile.rows
        even, odd = ee - cc, ec - fc
        ee += cc
        ec += fc
        self._add_rows(self.planes[k, j], rows, tile, even + odd, ec - ee)
        even -= odd
        ee += ec
        self._add_rows(self.planes[k, j], self._heads[rows], tile, np.negative(ee, out=ee), even)

    def _add_rows(
        self, plane: FloatArray, rows: slice | IntArray, tile: Tile, at_tails: FloatArray, at_heads: FloatArray
    ) -> None:
        """Add entries for the tails and for the heads of the tile's columns to rows of a plane."""
        first = tile.columns.start
        for last in self.mesh.edge_offsets[1:] - 1:
            # the head of a component's last edge is not the tail of the next one
            if last >= first:
                plane[rows, self._heads[last]] += at_heads[:, last - first]
                at_heads[:, last - first] = 0.0
        at_tails[:, 1:] += at_heads[:, :-1]
        plane[rows, tile.columns] += at_tails

    def symmetric_matrix(self, own: OwnBlocks, factor: float) -> FloatArray:
        """``factor`` times the sum of all blocks, with the transposed ones; shape (n·m, n·m)."""
        m, _, n, _ = self.planes.shape
        matrix = np.empty((n, m, n, m))
        for k in range(m):
            for j in range(m):
                np.add(self.planes[k, j], self.planes[j, k].T, out=matrix[:, k, :, j])
        matrix *= factor
        if not self.mesh.all_closed:  # else this would be a copy
            matrix = matrix[self._numbers][:, :, self._numbers]
        own.add_to(matrix, self.mesh, factor)
        return matrix.reshape(n * m, n * m)
