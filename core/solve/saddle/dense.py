"""Tangent spaces with a dense or a sparse inner product, by the structure of the saddle-point system (41) of [RS21].

The paper factorises the dense matrix of (m+1) n + m rows.  With J = A ⊗ Id_m, D the edge differences and t_I = τ_I/ℓ_I
the Schur complement of the length rows is the Hadamard product (t tᵀ) ∘ (D A⁻¹ Dᵀ), to which p barycenters add p·m
rows, so two Cholesky factorisations of size n do.  Pins leave to A⁻¹ the functions that vanish there.

A sparse matrix is factorised as it is; barycenters, whose rows are dense, are a border of as many more solves.
"""

from typing import Protocol

import numpy as np
import scipy.sparse as sp
from scipy.linalg import blas, lapack
from scipy.sparse.linalg import SuperLU, splu

from ...base.types import FloatArray
from ...energies.edge_pairs import ROWS_TIMES_COLUMNS
from ..constraints import ConstraintDerivative
from .tangent_space import TangentSpace, WholeSpace


class WithInverse(Protocol):
    """A Gram matrix A whose inverse is at hand, on functions that vanish at pins continued by 0."""

    @property
    def inverse(self) -> FloatArray:
        """A⁻¹ in full, shape (n, n), in Fortran order."""

    def apply(self, u: FloatArray) -> FloatArray:
        """A u, shape (n, k)."""

    def solve(self, f: FloatArray) -> FloatArray:
        """A⁻¹ f, shape (n, k)."""


class DenseTangentSpace(TangentSpace):
    """Constraints of full rank, J = A ⊗ Id_m; LinAlgError unless A and the Schur complement are positive definite."""

    def __init__(self, inner: WithInverse, constraints: ConstraintDerivative) -> None:
        super().__init__(constraints)
        self._inner = inner
        self._schur = cholesky(_schur_complement(inner, constraints))

    def solve(self, eta: FloatArray | None, xi: FloatArray | None) -> tuple[FloatArray, FloatArray]:
        """Solve the Schur complement's system for λ, then for u."""
        c = self.constraints
        free = np.zeros(c.shape) if eta is None else self._inner.solve(eta)
        right = c.apply(free)
        if xi is not None:
            right -= xi
        multipliers = substituted(self._schur, right)
        return free - self._inner.solve(c.apply_transpose(multipliers)), multipliers

    def apply(self, u: FloatArray) -> FloatArray:
        return self._inner.apply(u)


class DenseWholeSpace(WholeSpace):
    """The whole space with J + Cᵀ w C: in (41) −1/w stands for the zero block, in a form that allows for w = 0."""

    def __init__(self, inner: WithInverse, constraints: ConstraintDerivative, weights: FloatArray) -> None:
        super().__init__(constraints, weights)
        self._inner = inner
        schur = _schur_complement(inner, constraints)
        schur *= np.sqrt(np.multiply.outer(weights, weights))  # (S + 1/w)⁻¹ = √w (√w S √w + 1)⁻¹ √w
        schur[np.diag_indices_from(schur)] += 1.0
        self._schur = cholesky(schur)

    def riesz(self, eta: FloatArray) -> FloatArray:
        """By the identity of Sherman, Morrison and Woodbury."""
        free, scale = self._inner.solve(eta), np.sqrt(self.weights)
        pull = scale * substituted(self._schur, scale * self.constraints.apply(free))
        return free - self._inner.solve(self.constraints.apply_transpose(pull))

    def apply(self, u: FloatArray) -> FloatArray:
        c = self.constraints
        return self._inner.apply(u) + c.apply_transpose(self.weights * c.apply(u))


def _schur_complement(inner: WithInverse, c: ConstraintDerivative) -> FloatArray:
    """C J⁻¹ Cᵀ in Fortran order, the lower triangle.

    D A⁻¹ Dᵀ comes from differences of rows and columns, block by block in the processor's cache.
    """
    edges, rows = len(c.tangents), len(c.edges)
    schur = np.zeros((edges + c.count - rows,) * 2, order="F")
    inverse, upper, tails, heads = inner.inverse.T, schur.T, c.mesh.tails, c.mesh.heads
    width = max(1, ROWS_TIMES_COLUMNS // edges)
    for first in range(0, edges, width):
        block = slice(first, min(edges, first + width))
        change = inverse[heads[block]]
        change -= inverse[tails[block]]
        part = upper[block, first:edges]
        np.subtract(change.take(heads[first:], axis=1), change.take(tails[first:], axis=1), out=part)
        part *= c.tangents[block] @ c.tangents[first:].T
    if rows < edges:
        kept = np.concatenate([c.edges, np.arange(edges, len(schur))])
        schur = np.asfortranarray(schur[np.ix_(kept, kept)])
    for k, row in enumerate(c.border(), rows):
        schur[k, :] = c.apply(inner.solve(row))
    return schur


def cholesky(matrix: FloatArray) -> FloatArray:
    """Lower factor of a symmetric positive definite matrix in Fortran order, which is overwritten."""
    factor, info = lapack.dpotrf(matrix, lower=1, clean=0, overwrite_a=1)
    if info != 0:
        raise np.linalg.LinAlgError(f"matrix is not positive definite: pivot {info} of {len(matrix)}")
    return np.asarray(factor)


def substituted(factor: FloatArray, right: FloatArray) -> FloatArray:
    """Solve L Lᵀ x = right for one right side; LAPACK's dpotrs is made for many and takes twice the time."""
    if not len(right):  # which BLAS refuses
        return right
    return np.asarray(blas.dtrsv(factor, blas.dtrsv(factor, right, lower=1), lower=1, trans=1))


class SparseTangentSpace(TangentSpace):
    """The tangent space of constraints of full rank, with J = A ⊗ Id_m for a sparse A; LinAlgError if singular."""

    def __init__(self, gram: sp.csr_array, constraints: ConstraintDerivative) -> None:
        super().__init__(constraints)
        self._gram = gram
        rows, m = len(constraints.edges), constraints.shape[1]
        self._free = _free(constraints)
        lengths, full = constraints.length_rows(), sp.kron(_vanishing(gram, constraints), sp.eye_array(m))
        self._factor = factorised(sp.block_array([[full, lengths.T], [lengths, None]]))
        border = np.reshape(list(constraints.border()), (-1, full.shape[0]))
        self._border = np.hstack([border, np.zeros((len(border), rows))])
        self._response = self._factor.solve(self._border.T)
        self._held = self._border @ self._response

    def solve(self, eta: FloatArray | None, xi: FloatArray | None) -> tuple[FloatArray, FloatArray]:
        rows, (n, m) = len(self.constraints.edges), self.constraints.shape
        eta = np.zeros((n, m)) if eta is None else self._free * eta
        xi = np.zeros(self.constraints.count) if xi is None else xi
        free = self._factor.solve(np.concatenate([eta.ravel(), xi[:rows]]))
        pull = np.linalg.solve(self._held, self._border @ free - xi[rows:])
        both = free - self._response @ pull
        return both[: n * m].reshape(n, m), np.concatenate([both[n * m :], pull])

    def apply(self, u: FloatArray) -> FloatArray:
        return np.asarray(self._gram @ u)


class SparseWholeSpace(WholeSpace):
    """The whole space with J + Cᵀ w C, which is sparse too."""

    def __init__(self, gram: sp.csr_array, constraints: ConstraintDerivative, weights: FloatArray) -> None:
        super().__init__(constraints, weights)
        self._free, lengths = _free(constraints), constraints.length_rows()
        full = sp.kron(_vanishing(gram, constraints), sp.eye_array(constraints.shape[1]))
        self._matrix = sp.csr_array(full + lengths.T @ sp.diags_array(weights) @ lengths)
        self._factor = factorised(self._matrix)

    def riesz(self, eta: FloatArray) -> FloatArray:
        return np.asarray(self._factor.solve((self._free * eta).ravel())).reshape(eta.shape)

    def apply(self, u: FloatArray) -> FloatArray:
        """(J + Cᵀ w C) u, for u that vanishes at pins."""
        return np.asarray(self._matrix @ u.ravel()).reshape(u.shape)


def _free(constraints: ConstraintDerivative) -> FloatArray:
    """0 at pins, 1 elsewhere; shape (n, 1)."""
    free = np.ones((constraints.shape[0], 1))
    free[constraints.pins] = 0.0
    return free


def _vanishing(gram: sp.csr_array, constraints: ConstraintDerivative) -> sp.csr_array:
    """A where functions are free; rows and columns of pins are those of the identity."""
    if not len(constraints.pins):
        return gram
    free = _free(constraints)[:, 0]
    return sp.csr_array(sp.diags_array(free) @ gram @ sp.diags_array(free) + sp.diags_array(1.0 - free))


def factorised(matrix: sp.sparray) -> SuperLU:
    """LU factors; a LinAlgError says if there are none."""
    try:
        return splu(sp.csc_array(matrix))
    except RuntimeError as error:  # SuperLU's word for a singular matrix
        raise np.linalg.LinAlgError(f"matrix is singular: {error}") from error
