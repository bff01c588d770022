"""Tangent spaces of the constraints: what methods ask of them, and dense and sparse ones, by the structure of (41).

The paper [RS21] factorises the dense matrix of (m+1) n + m rows.  With J = A ⊗ Id_m, D the edge differences and
t_I = τ_I/ℓ_I the Schur complement of the length rows is the Hadamard product (t tᵀ) ∘ (D A⁻¹ Dᵀ), to which p
barycenters add p·m rows, so two Cholesky factorisations of size n do.  Pins leave to A⁻¹ the functions that vanish
there.

A sparse matrix is factorised as it is; barycenters, whose rows are dense, are a border of as many more solves.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable
from functools import partial

import numpy as np
import scipy.sparse as sp
from scipy.linalg import blas, lapack
from scipy.sparse.linalg import SuperLU, splu

from ...base import FloatArray, dot
from ...curve import Curve, free_edges, holds
from ...energies.edge_pairs import ROWS_TIMES_COLUMNS
from ..constraints import ConstraintDerivative, Constraints

LinearMap = Callable[[FloatArray], FloatArray]


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

    def __init__(self, product: LinearMap, constraints: ConstraintDerivative, weights: FloatArray | None) -> None:
        self._product, self.constraints, self.weights = product, constraints, weights  # u ↦ A u

    @abstractmethod
    def solve(self, eta: FloatArray | None, xi: FloatArray | None) -> tuple[FloatArray, FloatArray]:
        """Solve for u, shape (n, m), and λ, shape (rows of C,); None stands for a zero right side."""

    def apply(self, u: FloatArray) -> FloatArray:
        """J u, or (J + Cᵀ w C) u, for u that vanishes at pins; shape (n, m)."""
        if self.weights is None:
            return self._product(u)
        c = self.constraints
        return self._product(u) + c.apply_transpose(self.weights * c.apply(u))

    def gradient(self, derivative: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Projected gradient u, shape (n, m), and multipliers λ, shape (rows of C,), of a derivative, shape (n, m)."""
        u, multipliers = self.solve(derivative, None)
        return self.constraints.symmetry.mean(u), multipliers

    def pseudo_inverse(self, xi: FloatArray) -> FloatArray:
        """C^† ξ, the shortest u with C u = ξ; shapes (rows of C,) -> (n, m)."""
        return self.constraints.symmetry.mean(self.solve(None, xi)[0])

    def restoration(self, constraints: Constraints, curve: Curve, residual: FloatArray) -> FloatArray:
        """A short u, (n, m), with DΦ u = −Φ near by; by default the Euclidean one in O(n)."""
        return euclidean_correction(constraints, curve, residual)

    def project(self, u: FloatArray) -> FloatArray:
        """The orthogonal projection of u, which vanishes at pins; shape (n, m)."""
        return u if self.weights is not None else self.constraints.symmetry.mean(self.solve(self.apply(u), None)[0])

    def norm(self, u: FloatArray) -> float:
        """√⟨u, J u⟩."""
        return float(np.sqrt(max(0.0, np.sum(u * self.apply(u)))))


def euclidean_correction(constraints: Constraints, curve: Curve, residual: FloatArray) -> FloatArray:
    """The solution of C u = −Φ, C = DΦ at the curve, that is shortest as lengths are concerned, in O(n); shape (n, m).

    Translations, which change no length, are left to barycenters.  At pins u is 0.  Φ has shape (r + k,) for r lengths
    and k rows of barycenters.  Where all edges of a closed component, or of an arc between two pins, are collinear, u
    is too large to be of any use.
    """
    ell, mesh, pins = curve.edge_lengths, curve.mesh, constraints.pins.vertices
    rows, free = free_edges(mesh, pins), np.where(holds(mesh, pins), 0.0, 1.0)
    tau, stretch = curve.edge_vectors / ell[:, None], np.zeros_like(ell)
    stretch[rows] = -ell[rows] * residual[: len(rows)]
    cosines = free[mesh.heads] * dot(tau, tau[mesh.next])
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
    u = free[:, None] * mesh.scatter(-pull, pull)
    return constraints.barycenters.corrected(curve, u, stretch, residual[len(rows) :])


class DenseTangentSpace(TangentSpace):
    """Constraints of full rank, or any with weights; LinAlgError unless A and the Schur complement are definite."""

    def __init__(
        self,
        matrix: FloatArray,
        inverse: FloatArray,
        constraints: ConstraintDerivative,
        weights: FloatArray | None = None,
    ) -> None:
        super().__init__(partial(symmetric_product, matrix), constraints, weights)
        self._solve = partial(symmetric_product, inverse)
        # C J⁻¹ Cᵀ in Fortran order, the lower triangle; D A⁻¹ Dᵀ comes from differences of rows and columns, block by
        # block in the processor's cache
        c, edges, rows = constraints, len(constraints.tangents), len(constraints.edges)
        schur = np.zeros((edges + c.count - rows,) * 2, order="F")
        columns, upper, tails, heads = inverse.T, schur.T, c.mesh.tails, c.mesh.heads
        width = max(1, ROWS_TIMES_COLUMNS // edges)
        for first in range(0, edges, width):
            block = slice(first, min(edges, first + width))
            change = columns[heads[block]]
            change -= columns[tails[block]]
            part = upper[block, first:edges]
            np.subtract(change.take(heads[first:], axis=1), change.take(tails[first:], axis=1), out=part)
            part *= c.tangents[block] @ c.tangents[first:].T
        if rows < edges:
            kept = np.concatenate([c.edges, np.arange(edges, len(schur))])
            schur = np.asfortranarray(schur[np.ix_(kept, kept)])
        for k, row in enumerate(c.border(), rows):
            schur[k, :] = c.apply(self._solve(row))
        if weights is not None:  # (S + 1/w)⁻¹ = √w (√w S √w + 1)⁻¹ √w, a form that allows for w = 0
            schur *= np.sqrt(np.multiply.outer(weights, weights))
            schur[np.diag_indices_from(schur)] += 1.0
        self._schur = cholesky(schur)

    def solve(self, eta: FloatArray | None, xi: FloatArray | None) -> tuple[FloatArray, FloatArray]:
        """Solve the Schur complement's system for λ, then for u; with weights by Sherman, Morrison and Woodbury."""
        c = self.constraints
        free = np.zeros(c.shape) if eta is None else self._solve(eta)
        right = c.apply(free)
        if self.weights is not None:
            scale = np.sqrt(self.weights)
            pull, multipliers = scale * substituted(self._schur, scale * right), np.zeros(c.count)
        else:
            pull = multipliers = substituted(self._schur, right if xi is None else right - xi)
        return free - self._solve(c.apply_transpose(pull)), multipliers


def symmetric_product(lower: FloatArray, u: FloatArray) -> FloatArray:
    """A u column by column: for the few that u has, BLAS's dsymm takes three times as long."""
    return np.stack([blas.dsymv(1.0, lower, column, lower=1) for column in u.T], axis=1)


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
    """Constraints of full rank, or lengths with weights, for a sparse A; LinAlgError if singular."""

    def __init__(
        self, gram: sp.csr_array, constraints: ConstraintDerivative, weights: FloatArray | None = None
    ) -> None:
        super().__init__(gram.__matmul__, constraints, weights)
        n, m = constraints.shape
        self._free = np.ones((n, 1))  # 0 at pins, whose rows and columns are those of the identity
        self._free[constraints.pins] = 0.0
        free = sp.diags_array(self._free[:, 0])
        if len(constraints.pins):
            gram = free @ gram @ free + sp.diags_array(1.0 - self._free[:, 0])
        full, lengths = sp.kron(gram, sp.eye_array(m)), constraints.length_rows()
        if weights is not None:
            full, lengths = full + lengths.T @ sp.diags_array(weights) @ lengths, lengths[:0]
        self._factor = factorised(sp.block_array([[full, lengths.T], [lengths, None]]))
        border = np.reshape(list(constraints.border()), (-1, full.shape[0]))
        self._border = np.hstack([border, np.zeros((len(border), lengths.shape[0]))])
        self._response = self._factor.solve(self._border.T)
        self._held = self._border @ self._response

    def solve(self, eta: FloatArray | None, xi: FloatArray | None) -> tuple[FloatArray, FloatArray]:
        (n, m), c = self.constraints.shape, self.constraints
        rows, size = len(c.edges) if self.weights is None else 0, n * m
        force = np.zeros(size) if eta is None else (self._free * eta).ravel()
        missing = np.zeros(c.count) if xi is None or self.weights is not None else xi
        free = self._factor.solve(np.concatenate([force, missing[:rows]]))
        pull = np.linalg.solve(self._held, self._border @ free - missing[len(c.edges) :])
        both = free - self._response @ pull
        return both[:size].reshape(n, m), np.concatenate([both[size:], np.zeros(len(c.edges) - rows), pull])


def factorised(matrix: sp.sparray, symmetric: bool = False) -> SuperLU:
    """LU factors; a LinAlgError says if there are none.

    Of a symmetric matrix pivots are those on the diagonal wherever these are not 0: they have its eigenvalues' signs.
    """
    how = {"permc_spec": "MMD_AT_PLUS_A", "diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
    try:
        return splu(sp.csc_array(matrix), **(how if symmetric else {}))
    except RuntimeError as error:  # SuperLU's word for a singular matrix
        raise np.linalg.LinAlgError(f"matrix is singular: {error}") from error
