"""The inner product J_C of Theorem 4.1 in [RS21], discretised as in Section 6.1.2.

For functions U on the vertices, u their piecewise linear interpolation and ΔU_I = U(I↑) − U(I↓),
⟨U, U⟩ is the sum over ordered pairs of edges with disjoint closures of

1. ℓ_I ℓ_J |ΔU_I/ℓ_I − ΔU_J/ℓ_J|² Σ_ij ω_i ω_j / r_ij²
2. ℓ_I ℓ_J Σ_ij ω_i ω_j |u_I(t_i) − u_J(t_j)|² / r_ij² · (1/r_ij² − 1/ϱ_ij²)

and of 3. |∫ u ds|².  The Gram matrix is A ⊗ Id_m (footnote 6): only A, of shape (n, n), is assembled.
"""

from dataclasses import dataclass
from itertools import product

import numpy as np

from ..curve import Curve
from ..curve.distances import points_at, squared_distances
from ..quadrature import MIDPOINT, Rule
from ..types import FloatArray
from .inner_product import MAX_DENSE_ROWS, DenseInnerProduct, InnerProduct
from .local import lumped_mass
from .pairs import arc_distances, difference_form, excluding_neighbours, row_blocks, slopes

# In both kernels r and ϱ are at least this many times ℓ_I + ℓ_J: the 1/r⁴ of nearer pairs would leave no digits to the
# others, and forbid the very motion that brings strands apart.  On curves that their mesh resolves it changes nothing.
MIN_DISTANCE = 0.25


@dataclass(frozen=True)
class MoebiusMetric:
    """Σ ℓ_I ℓ_J (|ΔU_I/ℓ_I − ΔU_J/ℓ_J|²/r² + |u_I − u_J|²/r² (1/r² − 1/ϱ²)) + |∫ u|², by a quadrature rule.

    The metric in which the Möbius energy's gradient flow is an ordinary differential equation.

    Parameters
    ----------
    rule
        The quadrature rule on every edge, by default the midpoint rule.
    """

    rule: Rule = MIDPOINT
    name = "moebius"
    description = "J_C of Theorem 4.1, extrinsic W^{3/2,2}"
    extends_penalty = True
    most_vertices = MAX_DENSE_ROWS

    def with_rule(self, rule: Rule) -> "MoebiusMetric":
        """J_C by another rule."""
        return MoebiusMetric(rule)

    def at(self, curve: Curve) -> InnerProduct:
        """Dense: every pair of edges weighs in."""
        mesh = curve.mesh
        points = list(zip(self.rule.points, self.rule.weights, strict=True))
        seminorm = np.zeros((len(curve), len(curve)))  # weights of term 1
        matrix = np.zeros_like(seminorm)
        for (t_i, omega_i), (t_j, omega_j) in product(points, repeat=2):
            inverse, density = _weights(curve, t_i, t_j)
            inverse *= omega_i * omega_j
            density *= omega_i * omega_j
            seminorm += inverse
            matrix += difference_form(density, mesh.interpolation(t_i), mesh.interpolation(t_j))
        slope = slopes(curve)
        matrix += difference_form(seminorm, slope, slope)
        weight = lumped_mass(curve)
        matrix += np.multiply.outer(weight, weight)
        return DenseInnerProduct(0.5 * (matrix + matrix.T))


def _weights(curve: Curve, t_i: float, t_j: float) -> tuple[FloatArray, FloatArray]:
    """ℓ_I ℓ_J/r² and ℓ_I ℓ_J/r² (1/r² − 1/ϱ²) for all pairs, 0 where closures meet; shapes (n, n)."""
    mesh, ell = curve.mesh, curve.edge_lengths
    n = mesh.size
    inverse, density = np.empty((n, n)), np.empty((n, n))
    x, y = points_at(curve, t_i), points_at(curve, t_j)
    for rows in row_blocks(mesh):
        nearest = MIN_DISTANCE * (ell[rows, None] + ell[None, :])
        rho = arc_distances(curve, t_i, t_j, rows)
        r2 = squared_distances(x[rows], y)
        r2 = np.maximum(r2, nearest**2)
        rho = np.maximum(rho, nearest)
        s = 1.0 / excluding_neighbours(r2, mesh, rows)
        rho = excluding_neighbours(rho, mesh, rows)
        np.multiply(s, ell[rows, None] * ell[None, :], out=inverse[rows])
        s -= 1.0 / (rho * rho)
        np.multiply(s, inverse[rows], out=density[rows])
    return inverse, density
