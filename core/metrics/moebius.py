"""The inner product J_C of Theorem 4.1 in [RS21], discretised as in Section 6.1.2.

For functions U on the vertices, u their piecewise linear interpolation and ΔU_I = U(I↑) − U(I↓),
⟨U, U⟩ is the sum over ordered pairs of edges with disjoint closures of

1. ℓ_I ℓ_J |ΔU_I/ℓ_I − ΔU_J/ℓ_J|² Σ_ij ω_i ω_j / r_ij²
2. ℓ_I ℓ_J Σ_ij ω_i ω_j |u_I(t_i) − u_J(t_j)|² / r_ij² · (1/r_ij² − 1/ϱ_ij²)

and of 3. |∫ u ds|².  The Gram matrix is A ⊗ Id_m (footnote 6): only A, of shape (n, n), is assembled.
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from ..curve import Curve, Mesh
from ..curve.distances import arc_distances, points_at, squared_distances
from ..errors import OptionError
from ..types import FloatArray

ROWS_TIMES_COLUMNS = 48_000  # entries of one block of rows, to stay in the processor's cache


@dataclass(frozen=True)
class MoebiusMetric:
    """J_C, the metric in which the Möbius energy's gradient flow is an ordinary differential equation.

    Parameters
    ----------
    points
        Number k of Gauss–Legendre points per edge; 1 is the midpoint rule.

    Raises
    ------
    OptionError
        If ``points`` is below 1.
    """

    points: int = 1
    name = "moebius"
    description = "J_C of Theorem 4.1, extrinsic W^{3/2,2}"

    def __post_init__(self) -> None:
        if self.points < 1:
            raise OptionError(f"points is {self.points}; the quadrature needs 1 point per edge or more")

    def matrix(self, curve: Curve) -> FloatArray:
        """Gram matrix A, symmetric positive definite, shape (n, n)."""
        mesh = curve.mesh
        t, omega = np.polynomial.legendre.leggauss(self.points)
        t, omega = 0.5 * (t + 1.0), 0.5 * omega
        seminorm = np.zeros((len(curve), len(curve)))  # weights of term 1
        matrix = np.zeros_like(seminorm)
        for i, t_i in enumerate(t):
            for j, t_j in enumerate(t):
                inverse, density = _weights(curve, float(t_i), float(t_j))
                inverse *= omega[i] * omega[j]
                density *= omega[i] * omega[j]
                seminorm += inverse
                matrix += _difference_form(density, mesh.interpolation(float(t_i)), mesh.interpolation(float(t_j)))
        slope = sp.csr_array(mesh.difference.multiply(1.0 / curve.edge_lengths[:, None]))
        matrix += _difference_form(seminorm, slope, slope)
        mass = 0.5 * mesh.scatter(curve.edge_lengths, curve.edge_lengths)
        matrix += np.multiply.outer(mass, mass)
        return 0.5 * (matrix + matrix.T)


def _weights(curve: Curve, t_i: float, t_j: float) -> tuple[FloatArray, FloatArray]:
    """ℓ_I ℓ_J/r² and ℓ_I ℓ_J/r² (1/r² − 1/ϱ²) for all pairs, 0 where closures meet; shapes (n, n)."""
    mesh, ell = curve.mesh, curve.edge_lengths
    n = mesh.size
    inverse, density = np.empty((n, n)), np.empty((n, n))
    x, y = points_at(curve, t_i), points_at(curve, t_j)
    block = max(1, ROWS_TIMES_COLUMNS // n)
    for first in range(0, n, block):
        rows = slice(first, min(n, first + block))
        r2 = squared_distances(x[rows], y)
        _exclude_neighbours(r2, mesh, rows)
        s = 1.0 / r2
        rho = arc_distances(curve, t_i, t_j, rows)
        _exclude_neighbours(rho, mesh, rows)
        np.multiply(s, ell[rows, None] * ell[None, :], out=inverse[rows])
        s -= 1.0 / (rho * rho)
        np.multiply(s, inverse[rows], out=density[rows])
    return inverse, density


def _exclude_neighbours(distance: FloatArray, mesh: Mesh, rows: slice) -> None:
    """Set distances of edges that share a vertex to inf, in place."""
    edges = np.arange(rows.start, rows.stop)
    for partner in (edges, mesh.heads[edges], mesh.previous[edges]):
        distance[edges - rows.start, partner] = np.inf


def _difference_form(weights: FloatArray, left: sp.csr_array, right: sp.csr_array) -> FloatArray:
    """Matrix of U ↦ Σ_IJ w_IJ ((left U)_I − (right U)_J)², up to its antisymmetric part."""
    # Q = leftᵀ diag(Σ_J w) left + rightᵀ diag(Σ_I w) right − 2 leftᵀ w right
    diagonal = left.T @ sp.diags_array(weights.sum(axis=1)) @ left
    diagonal = diagonal + right.T @ sp.diags_array(weights.sum(axis=0)) @ right
    mixed = left.T @ weights
    mixed = (right.T @ mixed.T).T
    mixed *= -2.0
    coo = sp.coo_array(diagonal)
    np.add.at(mixed, (coo.coords[0], coo.coords[1]), coo.data)
    return np.asarray(mixed)
