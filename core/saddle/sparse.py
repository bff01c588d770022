"""Tangent spaces with a sparse inner product: the system (41) of [RS21] by a sparse factorisation.

Barycenters, whose rows are dense, are a border: it takes as many more solves as they have rows.
"""

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import SuperLU, splu

from ..constraints import ConstraintDerivative
from ..types import FloatArray
from .tangent_space import TangentSpace, WholeSpace


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
