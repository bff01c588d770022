"""What the nonlocal metrics share: blocks of rows of pair matrices, and forms in differences of edge values."""

from collections.abc import Iterator

import numpy as np
import scipy.sparse as sp

from ..curve import Curve, Mesh
from ..curve.distances import arc_distance_of_pairs
from ..types import FloatArray

ROWS_TIMES_COLUMNS = 48_000  # entries of one block of rows, to stay in the processor's cache


def row_blocks(mesh: Mesh) -> Iterator[slice]:
    """Blocks of rows that cover a pair matrix."""
    block = max(1, ROWS_TIMES_COLUMNS // mesh.size)
    for first in range(0, mesh.size, block):
        yield slice(first, min(mesh.size, first + block))


def arc_distances(curve: Curve, t_i: float, t_j: float, rows: slice) -> FloatArray:
    """ϱ between the points at ``t_i`` of the edges in ``rows`` and at ``t_j`` of all edges; inf across components."""
    edges = np.arange(len(curve))
    return arc_distance_of_pairs(curve, edges[rows, None], edges[None, :], t_i, t_j)


def excluding_neighbours(distance: FloatArray, mesh: Mesh, rows: slice) -> FloatArray:
    """Set distances of edges that share a vertex to inf, in place, and return the array."""
    edges = np.arange(rows.start, rows.stop)
    for partner in (edges, mesh.heads[edges], mesh.previous[edges]):
        distance[edges - rows.start, partner] = np.inf
    return distance


def slopes(curve: Curve) -> sp.csr_array:
    """Matrix of ΔU_I/ℓ_I; shape (n, n)."""
    return sp.csr_array(curve.mesh.difference.multiply(1.0 / curve.edge_lengths[:, None]))


def difference_form(weights: FloatArray, left: sp.csr_array, right: sp.csr_array) -> FloatArray:
    """Matrix of U ↦ Σ_IJ w_IJ ((left U)_I − (right U)_J)², up to its antisymmetric part; shape (n, n)."""
    # leftᵀ diag(Σ_J w) left + rightᵀ diag(Σ_I w) right − 2 leftᵀ w right
    # (compressed rows, because products of dense matrices with compressed columns are three times slower)
    left_t, right_t = sp.csr_array(left.T), sp.csr_array(right.T)
    diagonal = left_t @ sp.diags_array(weights.sum(axis=1)) @ left
    diagonal = sp.coo_array(diagonal + right_t @ sp.diags_array(weights.sum(axis=0)) @ right)
    form = (right_t @ (left_t @ weights).T).T
    form *= -2.0
    np.add.at(form, (diagonal.coords[0], diagonal.coords[1]), diagonal.data)
    return np.asarray(form)
