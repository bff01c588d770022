"""The saddle-point system (41) of [RS21], solved through its structure.

    [ J  Cᵀ ] (u)   (η)
    [ C  0  ] (λ) = (ξ),      J = A ⊗ Id_m,  C = DΦ(P).

The paper factorises the dense matrix of (m+1) n + m rows.  With D the edge differences and t_I = τ_I/ℓ_I the
Schur complement of the length rows is the Hadamard product (t tᵀ) ∘ (D A⁻¹ Dᵀ), to which the barycenter adds
m rows, so two Cholesky factorisations of size n do.  Three right sides share them: (DE, 0) gives the projected
gradient, (0, ξ) the pseudo-inverse C^† ξ with respect to the metric, (J v, 0) the orthogonal projection of v.
"""

import numpy as np
from scipy.linalg import blas, lapack

from .constraints import ConstraintDerivative
from .types import FloatArray


class SaddleSolver:
    """Factorised saddle-point matrix at one curve.

    Parameters
    ----------
    matrix
        Gram matrix A of the metric, symmetric positive definite, shape (n, n).
    constraints
        DΦ at the curve, of full rank.
    weights
        None for hard constraints.  Otherwise w ≥ 0, shape (rows of DΦ,), turns the constraints into the part DΦᵀ w DΦ
        of the metric, which is how the penalised problems of Section 6.4 use it: −1/w stands in place of the zero
        block, in a form that has a meaning for w = 0 too.

    Raises
    ------
    numpy.linalg.LinAlgError
        If A or the Schur complement is not positive definite to working precision.
    """

    def __init__(
        self, matrix: FloatArray, constraints: ConstraintDerivative, weights: FloatArray | None = None
    ) -> None:
        self.matrix = np.asfortranarray(matrix)
        self.constraints = constraints
        self._weights = weights
        self._inverse = _inverse(self.matrix)
        schur = self._schur_complement()
        if weights is not None:  # (S + 1/w)⁻¹ = √w (√w S √w + 1)⁻¹ √w
            schur *= np.sqrt(np.multiply.outer(weights, weights))
            schur[np.diag_indices_from(schur)] += 1.0
        self._schur = _cholesky(schur)

    def solve(self, eta: FloatArray | None, xi: FloatArray | None) -> tuple[FloatArray, FloatArray]:
        """Solve for u, shape (n, m), and λ, shape (n + m,); None stands for a zero right side.

        ``eta`` has shape (n, m), ``xi`` shape (n + m,).
        """
        c = self.constraints
        free = np.zeros(c.tangents.shape) if eta is None else self._apply_inverse(eta)
        right = c.apply(free)
        if xi is not None:
            right -= xi
        scale = 1.0 if self._weights is None else np.sqrt(self._weights)
        multipliers = scale * lapack.dpotrs(self._schur, scale * right, lower=1)[0]
        u = free - self._apply_inverse(c.apply_transpose(multipliers))
        return u, multipliers

    def gradient(self, derivative: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Projected gradient u and multipliers λ of a derivative, shape (n, m).

        With weighted constraints u is the gradient in the extended metric.
        """
        return self.solve(derivative, None)

    def pseudo_inverse(self, xi: FloatArray) -> FloatArray:
        """C^† ξ: the metrically shortest u with C u = ξ."""
        return self.solve(None, xi)[0]

    def project(self, u: FloatArray) -> FloatArray:
        """Project u orthogonally (in the metric) onto the tangent space C u = 0."""
        return self.solve(self.apply_metric(u), None)[0]

    def apply_metric(self, u: FloatArray) -> FloatArray:
        """J u, with the constraints' part DΦᵀ w DΦ u if they are weighted; shape (n, m)."""
        image = np.ascontiguousarray(blas.dsymm(1.0, self.matrix, np.asfortranarray(u), lower=1))
        if self._weights is not None:
            image += self.constraints.apply_transpose(self._weights * self.constraints.apply(u))
        return image

    def norm(self, u: FloatArray) -> float:
        """Length of u in the metric."""
        return float(np.sqrt(max(0.0, np.sum(u * self.apply_metric(u)))))

    def _apply_inverse(self, eta: FloatArray) -> FloatArray:
        return np.ascontiguousarray(blas.dsymm(1.0, self._inverse, np.asfortranarray(eta), lower=1))

    def _schur_complement(self) -> FloatArray:
        c = self.constraints
        n = len(c.tangents)
        difference = c.mesh.difference
        half = difference @ self._inverse
        rows = len(c.barycenter)
        schur = np.empty((n + rows, n + rows), order="F")
        # symmetric, so D (D A⁻¹)ᵀ is the product in either storage order
        np.multiply(difference @ half.T, c.tangents @ c.tangents.T, out=schur[:n, :n])
        for k in range(rows):
            response = self._apply_inverse(c.barycenter[k])
            schur[n + k, :] = c.apply(response)
        schur[:n, n:] = schur[n:, :n].T
        return schur


def _cholesky(matrix: FloatArray) -> FloatArray:
    factor, info = lapack.dpotrf(matrix, lower=1, clean=0, overwrite_a=1)
    if info != 0:
        raise np.linalg.LinAlgError(f"matrix is not positive definite: pivot {info} of {len(matrix)}")
    return np.asarray(factor)


def _inverse(matrix: FloatArray) -> FloatArray:
    """Full inverse of a symmetric positive definite matrix in Fortran order."""
    inverse, info = lapack.dpotri(_cholesky(matrix.copy(order="F")), lower=1, overwrite_c=1)
    if info != 0:
        raise np.linalg.LinAlgError(f"matrix is singular: pivot {info} of {len(matrix)}")
    block = 128
    for first in range(0, len(inverse), block):
        last = first + block
        diagonal = inverse[first:last, first:last]
        diagonal[...] = np.tril(diagonal) + np.tril(diagonal, -1).T
        inverse[first:last, last:] = inverse[last:, first:last].T
    return np.asarray(inverse)
