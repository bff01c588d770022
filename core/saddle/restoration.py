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
        Φ, shape (n + p·m,) for p parts.

    Returns
    -------
    u
        Too large to be of any use if all edges of a component are collinear.
    """
    ell, mesh, n = curve.edge_lengths, curve.mesh, len(curve)
    tau, stretch = curve.edge_vectors / ell[:, None], -ell * residual[:n]
    tension = _solve_gram(mesh, np.einsum("ij,ij->i", tau, tau[mesh.heads]), stretch)
    pull = tension[:, None] * tau
    u = mesh.scatter(-pull, pull)
    # what the change of lengths does to Σ ℓ_I m_I, translations are to undo
    moments = stretch[:, None] * curve.midpoints + (0.5 * ell)[:, None] * (u[mesh.tails] + u[mesh.heads])
    part = np.asarray(constraints.parts or (0,) * len(mesh.component_sizes))[mesh.component]
    for k, missing in enumerate(-residual[n:].reshape(-1, curve.dimension)):
        own = part == k
        u[own] += (missing - moments[own].sum(axis=0)) / ell[own].sum()
    return u


def _solve_gram(mesh: Mesh, cosines: FloatArray, right: FloatArray) -> FloatArray:
    """Solve T x = right, T having 2 on the diagonal and −cosines[I] between edge I and the one after it; shape (n,).

    Each component's block is T₀ − |c| w wᵀ, c its corners and w supported on its first and last edge: T₀ is tridiagonal
    and positive definite, the rest is the formula of Sherman and Morrison.
    """
    first, last = mesh.offsets[:-1], mesh.offsets[1:] - 1
    corner, sign = np.abs(cosines[last]), np.copysign(1.0, cosines[last])
    diagonal, beside, w = np.full(mesh.size, 2.0), -cosines[:-1], np.zeros(mesh.size)
    beside[last[:-1]] = 0.0
    diagonal[first] += corner
    diagonal[last] += corner
    w[first], w[last] = 1.0, sign
    _, _, solutions, _ = lapack.dptsv(diagonal, beside, np.column_stack([right, w]))
    x, z = np.asarray(solutions).T
    rest = np.maximum(1.0 - corner * (z[first] + sign * z[last]), np.finfo(np.float64).eps)  # 0 if all is collinear
    share = corner * (x[first] + sign * x[last]) / rest
    return np.asarray(x + share[mesh.component] * z)
