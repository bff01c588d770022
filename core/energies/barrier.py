"""The barrier that a one-point rule lacks: near pairs of edges get their exact energy instead.

    B = Σ χ(q_IJ) (W_exact − W_mid),   q = |Δ|²/(ℓ_I + ℓ_J)²,

over ordered pairs of different components or at index distance 4 or more.  χ is a C² cutoff, 1 up to
q = 1 and 0 from q = 9/4, so B is one C² function of the vertices and vanishes on well-resolved curves.
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from ..curve import Curve
from ..types import FloatArray
from .contributions import Contributions
from .edge_pairs import EdgePairs, scatter_first, scatter_second
from .jets import Jet
from .near_pairs import FAR, near_pairs

NEAR = 1.0  # of q, where the cutoff leaves 1; it reaches 0 at FAR
BLOCK = 192  # pairs whose 3m × 3m matrices are handled at once, to stay in the processor's cache


@dataclass(frozen=True)
class Barrier:
    """B, the difference between exact and midpoint energy over near pairs of edges."""

    name = "barrier"
    description = "exact minus midpoint energy of near pairs of edges"

    def value(self, curve: Curve) -> float:
        """B; 0 when strands are further apart than edges are long."""
        return self.value_and_derivative(curve)[0]

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        """B and its derivative with respect to the vertices, shape (n, m)."""
        i, j = near_pairs(curve)
        if not len(i):
            return 0.0, np.zeros_like(curve.vertices)
        jet = _contributions(EdgePairs.of(curve, i, j))
        # unordered pairs are listed, the sum is over ordered ones
        return 2.0 * float(jet.value.sum()), 2.0 * scatter_first(curve.mesh, i, j, jet.first)

    def hessian(self, curve: Curve) -> FloatArray:
        """Second derivative D²B, symmetric, shape (n·m, n·m), in the order of ``vertices.ravel()``."""
        return np.asarray(self.sparse_hessian(curve).toarray())

    def sparse_hessian(self, curve: Curve) -> sp.csr_array:
        """D²B as a sparse matrix: it couples near edges only."""
        i, j = near_pairs(curve)
        size = 3 * curve.dimension
        second = np.empty((len(i), size, size))
        for first in range(0, len(i), BLOCK):
            part = slice(first, first + BLOCK)
            second[part] = _contributions(EdgePairs.of(curve, i[part], j[part]).with_coordinates()).second
        return 2.0 * scatter_second(curve.mesh, i, j, second)

    def hessian_product(self, curve: Curve, v: FloatArray) -> FloatArray:
        """D²B v for ``v`` of shape (n, m); shape (n, m)."""
        i, j = near_pairs(curve)
        if not len(i):
            return np.zeros_like(v)
        jet = _contributions(EdgePairs.of(curve, i, j).moving(curve.mesh, i, j, v))
        return 2.0 * scatter_first(curve.mesh, i, j, jet.second[:, :, 0])


def _contributions(pairs: EdgePairs) -> Jet:
    """χ (W_exact − W_mid) of pairs of edges."""
    w = Contributions(pairs)
    q = w.closeness()
    return q.compose(*cutoff(q.value)) * (w.exact() - w.midpoint())


def cutoff(q: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """χ(q), the quintic smoothstep from 1 (q ≤ 1) to 0 (q ≥ 9/4), and its first and second derivative."""
    x = np.clip((FAR - q) / (FAR - NEAR), 0.0, 1.0)
    product = x * (1.0 - x)
    slope, curvature = 30.0 * product**2, 60.0 * product * (1.0 - 2.0 * x)
    chi = np.asarray(x**3 * (10.0 - 15.0 * x + 6.0 * x * x))
    return chi, -slope / (FAR - NEAR), curvature / (FAR - NEAR) ** 2
