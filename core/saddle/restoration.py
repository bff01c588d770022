"""The last, small corrections towards the constraints: in the Euclidean metric C Cᵀ is tridiagonal but for corners."""

import numpy as np
from scipy.linalg import lapack

from ..constraints import Constraints
from ..curve import Curve, Mesh
from ..curve.pins import free_edges, holds
from ..types import FloatArray


def euclidean_correction(constraints: Constraints, curve: Curve, residual: FloatArray) -> FloatArray | None:
    """The solution of C u = −Φ, C = DΦ at the curve, that is shortest as lengths are concerned, in O(n); shape (n, m).

    What changes no length, such as a translation, is left to the blocks of further rows.  At pins u is 0.  Φ has shape
    (r + k,) for r lengths and k rows of blocks.  Where all edges of a closed component, or of an arc between two pins,
    are collinear, u is too large to be of any use; it is None if a block knows no such correction.
    """
    ell, mesh, pins = curve.edge_lengths, curve.mesh, constraints.pins.vertices
    rows, free = free_edges(mesh, pins), np.where(holds(mesh, pins), 0.0, 1.0)
    tau, stretch = curve.edge_vectors / ell[:, None], np.zeros_like(ell)
    stretch[rows] = -ell[rows] * residual[: len(rows)]
    cosines = free[mesh.heads] * np.einsum("ij,ij->i", tau, tau[mesh.next])
    diagonal = np.maximum(free[mesh.tails] + free[mesh.heads], 1.0)  # 1 where there is no row, and nothing to solve
    tension = _solve_gram(mesh, diagonal, cosines, stretch)
    pull = tension[:, None] * tau
    u: FloatArray | None = free[:, None] * mesh.scatter(-pull, pull)
    for block, own in constraints.of_blocks(residual[len(rows) :]):
        u = None if u is None else block.corrected(curve, u, stretch, own)
    return u


def _solve_gram(mesh: Mesh, diagonal: FloatArray, cosines: FloatArray, right: FloatArray) -> FloatArray:
    """Solve T x = right, T having ``diagonal`` and −cosines[I] between edge I and the one after it; shape (edges,).

    Each component's block is T₀ − |c| w wᵀ, c its corners, 0 on arcs, and w supported on its first and last edge: T₀ is
    tridiagonal and positive definite, the rest is the formula of Sherman and Morrison.
    """
    first, last = mesh.edge_offsets[:-1], mesh.edge_offsets[1:] - 1
    corner, sign = np.where(mesh.closed, np.abs(cosines[last]), 0.0), np.copysign(1.0, cosines[last])
    beside, w = -cosines[: max(mesh.edges - 1, 1)], np.zeros(mesh.edges)
    beside[last[:-1]] = 0.0
    diagonal[first] += corner
    diagonal[last] += corner
    w[first], w[last] = 1.0, sign
    _, _, solutions, _ = lapack.dptsv(diagonal, beside, np.column_stack([right, w]))
    x, z = np.asarray(solutions).T
    rest = np.maximum(1.0 - corner * (z[first] + sign * z[last]), np.finfo(np.float64).eps)  # 0 if all is collinear
    share = corner * (x[first] + sign * x[last]) / rest
    return np.asarray(x + share[mesh.edge_component] * z)
