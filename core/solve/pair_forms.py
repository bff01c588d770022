"""Quadratic forms in differences of edge values, over all pairs of edges, with one weight a block.

On a block of clusters c and d, of lengths L_c and L_d, a form in edge values x is

    Σ_{I∈c, J∈d} w ℓ_I ℓ_J (x_I − x_J)² = w (L_d Σ_c ℓ x² + L_c Σ_d ℓ x²) − 2 w (Σ_c ℓ x) (Σ_d ℓ x),

a diagonal and a product of two integrals.  For slopes x_I = ΔU_I/ℓ_I these telescope to U(head of c) − U(tail of c),
and for values they are differences of a running sum z: either way a sparse matrix of four entries a block.
"""

from functools import cached_property

import numpy as np
import scipy.sparse as sp

from ..base.types import BoolArray, FloatArray, IntArray
from ..curve import Curve, Mesh
from ..energies.hierarchy.blocks import BlockList

EdgePairs = tuple[IntArray, IntArray]


class PairForms:
    """Forms on a block list over ordered pairs; weights ``near`` are those of near pairs, ``far`` those of blocks."""

    def __init__(self, curve: Curve, blocks: BlockList) -> None:
        self._curve, self._blocks = curve, blocks
        tree = blocks.tree
        ends = np.concatenate([[0.0], np.cumsum(curve.edge_lengths[tree.order])])
        lengths = ends[tree.stop] - ends[tree.start]
        self._length_c, self._length_d = lengths[blocks.first], lengths[blocks.second]

    def of_slopes(self, near: FloatArray, far: FloatArray) -> sp.csr_array:
        """The matrix of Σ w ℓ_I ℓ_J |ΔU_I/ℓ_I − ΔU_J/ℓ_J|², shape (n, n), but for what `of_long_slopes` adds."""
        mesh, order, (a, b, c, d) = self._curve.mesh, self._blocks.tree.order, self._blocks.ranges
        weights = np.where(self._in_components, far, 0.0)
        first = mesh.tails[order[a]], mesh.heads[order[b - 1]]
        second = mesh.tails[order[c]], mesh.heads[order[d - 1]]
        slope = sp.diags_array(1.0 / self._curve.edge_lengths) @ mesh.difference
        return sp.csr_array(slope.T @ self._on_edges(near, far) @ slope - _products(weights, first, second, mesh.size))

    def of_long_slopes(self, far: FloatArray) -> sp.csr_array:
        """The rest of `of_slopes`, on running sums of ΔU, (edges + 1) twice: 0 where all components are closed."""
        a, b, c, d = self._blocks.ranges
        return -_products(np.where(self._in_components, 0.0, far), (a, b), (c, d), self._curve.mesh.edges + 1)

    def of_values(self, near: FloatArray, far: FloatArray) -> tuple[sp.csr_array, sp.csr_array]:
        """The matrices of Σ w ℓ_I ℓ_J |u_I − u_J|², u at midpoints: on U, shape (n, n), and on z, (edges + 1) twice."""
        average, (a, b, c, d) = self._curve.mesh.average, self._blocks.ranges
        local = sp.csr_array(average.T @ self._on_edges(near, far) @ average)
        return local, -_products(far, (a, b), (c, d), self._curve.mesh.edges + 1)

    def of_components(self, near: FloatArray, far: FloatArray) -> sp.csr_array:
        """`of_values` on functions constant on components, (components,) twice, without blocks that hold several."""
        ell, component = self._curve.edge_lengths, self._curve.mesh.edge_component
        (i, j), (c, d), single = self._blocks.near, self._blocks.middles, self._in_components
        first = component[np.concatenate([i, c[single]])]
        second = component[np.concatenate([j, d[single]])]
        weights = np.concatenate([near * ell[i] * ell[j], (far * self._length_c * self._length_d)[single]])
        count = len(self._curve.mesh.component_sizes)
        off = _symmetric(2.0 * weights, first, second, count)
        return sp.csr_array(sp.diags_array(off.sum(axis=1)) - off)

    @cached_property
    def _in_components(self) -> BoolArray:
        """Whether each of the two clusters of a block is within one component; shape (blocks,)."""
        (a, b, c, d), component = self._blocks.ranges, self._curve.mesh.edge_component[self._blocks.tree.order]
        return np.asarray((component[a] == component[b - 1]) & (component[c] == component[d - 1]))

    def _on_edges(self, near: FloatArray, far: FloatArray) -> sp.csr_array:
        """Near pairs, and the diagonal of the blocks, in edge values; shape (edges, edges)."""
        ell, (i, j) = self._curve.edge_lengths, self._blocks.near
        off = _symmetric(2.0 * near * ell[i] * ell[j], i, j, len(ell))
        # Σ w L_d for each edge over the blocks with a cluster c that holds it
        b, tree = self._blocks, self._blocks.tree
        total = np.bincount(b.first, far * self._length_d, tree.size)
        total += np.bincount(b.second, far * self._length_c, tree.size)
        for inner, child in tree.downward():
            total[child] += total[inner]
            total[child + 1] += total[inner]
        leaves = tree.leaves()
        at_edges = np.empty(len(tree.order))
        at_edges[tree.order] = np.repeat(total[leaves], (tree.stop - tree.start)[leaves])
        return sp.csr_array(sp.diags_array(off.sum(axis=1) + 2.0 * ell * at_edges) - off)


def _products(weights: FloatArray, c: EdgePairs, d: EdgePairs, size: int) -> sp.csr_array:
    """The matrix of Σ 4 w (x_b − x_a) (x_d − x_c) for index pairs (a, b) and (c, d)."""
    (a, b), (c_, d_) = c, d
    rows, columns = np.concatenate([b, a, b, a]), np.concatenate([d_, c_, c_, d_])
    return _symmetric(np.concatenate([2.0 * weights] * 2 + [-2.0 * weights] * 2), rows, columns, size)


def _symmetric(values: FloatArray, rows: IntArray, columns: IntArray, size: int) -> sp.csr_array:
    half = sp.csr_array((values, (rows, columns)), shape=(size, size))
    return sp.csr_array(half + half.T)


class RunningSum:
    """B: u ↦ z, z_k = Σ w_I (u(I↑) + s u(I↓)) over the first k edges in an order; weights w and order (edges,)."""

    def __init__(self, mesh: Mesh, order: IntArray, weights: FloatArray, sign: float) -> None:
        self._mesh, self._sign = mesh, sign
        self._tails, self._heads = mesh.tails[order], mesh.heads[order]
        self._weights = weights[order, None]
        self._place = np.empty_like(order)
        self._place[order] = np.arange(len(order))

    @classmethod
    def of_values(cls, curve: Curve, order: IntArray) -> "RunningSum":
        """∫ u, by the values at midpoints."""
        return cls(curve.mesh, order, 0.5 * curve.edge_lengths, 1.0)

    @classmethod
    def of_slopes(cls, curve: Curve, order: IntArray) -> "RunningSum":
        """∫ u'."""
        return cls(curve.mesh, order, np.ones(curve.mesh.edges), -1.0)

    def apply(self, u: FloatArray) -> FloatArray:
        """B u; shapes (n, k) -> (edges + 1, k)."""
        z = np.zeros((len(self._place) + 1, u.shape[1]))
        np.cumsum(self._weights * (u[self._heads] + self._sign * u[self._tails]), axis=0, out=z[1:])
        return z

    def apply_transpose(self, y: FloatArray) -> FloatArray:
        """Bᵀ y; shapes (edges + 1, k) -> (n, k)."""
        back = (self._weights * np.cumsum(y[:0:-1], axis=0)[::-1])[self._place]
        return self._mesh.scatter(self._sign * back, back)
