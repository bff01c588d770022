"""What methods ask of a tangent space, which `dense` and `iterative` answer."""

from abc import ABC, abstractmethod
from typing import Protocol

import numpy as np
from scipy.linalg import lapack

from ...base.types import FloatArray
from ...curve import Curve
from ...curve.pins import free_edges, holds
from ..constraints import ConstraintDerivative, Constraints


class Applied(Protocol):
    """A Gram matrix A of which products are known."""

    def apply(self, u: FloatArray) -> FloatArray:
        """A u, shape (n, k)."""


class TangentSpace(ABC):
    """The tangent space {u : C u = 0, u = 0 at pins}, C = DΦ(P), with an inner product J = A ⊗ Id_m on all of R^(n·m).

    All of it rests on the saddle-point system (41) of [RS21],

        [ J  Cᵀ ] (u)   (η)
        [ C  0  ] (λ) = (ξ),

    with the rows and columns of pins left out, for three right sides: (DE, 0) gives the projected gradient, (0, ξ) the
    pseudo-inverse C^† ξ, (J v, 0) the projection of v.

    With ``weights`` w ≥ 0, one a row of C, it is the whole space but pins with J + Cᵀ w C, as Section 6.4 of [RS21]
    penalises lengths: −1/w stands for the zero block, ξ is of no consequence, and multipliers are 0.
    """

    def __init__(self, inner: Applied, constraints: ConstraintDerivative, weights: FloatArray | None) -> None:
        self._inner, self.constraints, self.weights = inner, constraints, weights

    @abstractmethod
    def solve(self, eta: FloatArray | None, xi: FloatArray | None) -> tuple[FloatArray, FloatArray]:
        """Solve for u, shape (n, m), and λ, shape (rows of C,); None stands for a zero right side."""

    def apply(self, u: FloatArray) -> FloatArray:
        """J u, or (J + Cᵀ w C) u, for u that vanishes at pins; shape (n, m)."""
        if self.weights is None:
            return self._inner.apply(u)
        c = self.constraints
        return self._inner.apply(u) + c.apply_transpose(self.weights * c.apply(u))

    def gradient(self, derivative: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Projected gradient u, shape (n, m), and multipliers λ, shape (rows of C,), of a derivative, shape (n, m)."""
        u, multipliers = self.solve(derivative, None)
        return self.constraints.symmetry.mean(u), multipliers

    def pseudo_inverse(self, xi: FloatArray) -> FloatArray:
        """C^† ξ, the shortest u with C u = ξ; shapes (rows of C,) -> (n, m)."""
        return self.constraints.symmetry.mean(self.solve(None, xi)[0])

    def restoration(self, constraints: Constraints, curve: Curve, residual: FloatArray) -> FloatArray | None:
        """A short u, (n, m), with DΦ u = −Φ near by; by default the Euclidean one in O(n), None if there is none."""
        return euclidean_correction(constraints, curve, residual)

    def project(self, u: FloatArray) -> FloatArray:
        """The orthogonal projection of u, which vanishes at pins; shape (n, m)."""
        return u if self.weights is not None else self.constraints.symmetry.mean(self.solve(self.apply(u), None)[0])

    def norm(self, u: FloatArray) -> float:
        """√⟨u, J u⟩."""
        return float(np.sqrt(max(0.0, np.sum(u * self.apply(u)))))


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
    # T has the diagonal, and −cosines[I] between edge I and the one after it.  Each component's block is T₀ − |c| w wᵀ,
    # c its corners, 0 on arcs, and w supported on its first and last edge: T₀ is tridiagonal and positive definite,
    # the rest is the formula of Sherman and Morrison.
    first, last = mesh.edge_offsets[:-1], mesh.edge_offsets[1:] - 1
    corner, sign = np.where(mesh.closed, np.abs(cosines[last]), 0.0), np.copysign(1.0, cosines[last])
    beside, w = -cosines[: max(mesh.edges - 1, 1)], np.zeros(mesh.edges)
    beside[last[:-1]] = 0.0
    diagonal[first] += corner
    diagonal[last] += corner
    w[first], w[last] = 1.0, sign
    _, _, solutions, _ = lapack.dptsv(diagonal, beside, np.column_stack([stretch, w]))
    x, z = np.asarray(solutions).T
    rest = np.maximum(1.0 - corner * (z[first] + sign * z[last]), np.finfo(np.float64).eps)  # 0 if all is collinear
    share = corner * (x[first] + sign * x[last]) / rest
    tension: FloatArray = x + share[mesh.edge_component] * z
    pull = tension[:, None] * tau
    u: FloatArray | None = free[:, None] * mesh.scatter(-pull, pull)
    for block, own in constraints.of_blocks(residual[len(rows) :]):
        u = None if u is None else block.corrected(curve, u, stretch, own)
    return u
