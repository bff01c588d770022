"""The last, small corrections towards the constraints: in the Euclidean metric C Cᵀ is tridiagonal but for corners."""

import numpy as np
from scipy.linalg import lapack

from ..constraints import Constraints
from ..curve import Curve, Mesh
from ..types import FloatArray


def euclidean_correction(constraints: Constraints, curve: Curve, residual: FloatArray) -> FloatArray:
    """The solution of C u = −Φ, C = DΦ at the curve, that is shortest up to translations, in O(n); shape (n, m).

    Lengths do not see translations, so these are left to the barycenters.

    Parameters
    ----------
    residual
        Φ, shape (edges + p·m,) for p parts.

    Returns
    -------
    u
        Too large to be of any use if all edges of a closed component are collinear.
    """
    ell, mesh, edges = curve.edge_lengths, curve.mesh, curve.mesh.edges
    tau, stretch = curve.edge_vectors / ell[:, None], -ell * residual[:edges]
    tension = _solve_gram(mesh, np.einsum("ij,ij->i", tau, tau[mesh.next]), stretch)
    pull = tension[:, None] * tau
    u = mesh.scatter(-pull, pull)
    # what the change of lengths does to Σ ℓ_I m_I, translations are to undo
    moments = stretch[:, None] * curve.midpoints + (0.5 * ell)[:, None] * (u[mesh.tails] + u[mesh.heads])
    part = np.asarray(constraints.parts or (0,) * len(mesh.component_sizes))
    for k, missing in enumerate(-residual[edges:].reshape(-1, curve.dimension)):
        own = (part == k)[mesh.edge_component]
        u[(part == k)[mesh.component]] += (missing - moments[own].sum(axis=0)) / ell[own].sum()
    return u


def _solve_gram(mesh: Mesh, cosines: FloatArray, right: FloatArray) -> FloatArray:
    """Solve T x = right, T having 2 on the diagonal and −cosines[I] between edges I and I + 1; shape (edges,).

    Each component's block is T₀ − |c| w wᵀ, c its corners, 0 on arcs, and w supported on its first and last edge: T₀ is
    tridiagonal and positive definite, the rest is the formula of Sherman and Morrison.
    """
    first, last = mesh.edge_offsets[:-1], mesh.edge_offsets[1:] - 1
    corner, sign = np.where(mesh.closed, np.abs(cosines[last]), 0.0), np.copysign(1.0, cosines[last])
    diagonal, beside, w = np.full(mesh.edges, 2.0), -cosines[: max(mesh.edges - 1, 1)], np.zeros(mesh.edges)
    beside[last[:-1]] = 0.0
    diagonal[first] += corner
    diagonal[last] += corner
    w[first], w[last] = 1.0, sign
    _, _, solutions, _ = lapack.dptsv(diagonal, beside, np.column_stack([right, w]))
    x, z = np.asarray(solutions).T
    rest = np.maximum(1.0 - corner * (z[first] + sign * z[last]), np.finfo(np.float64).eps)  # 0 if all is collinear
    share = corner * (x[first] + sign * x[last]) / rest
    return np.asarray(x + share[mesh.edge_component] * z)
