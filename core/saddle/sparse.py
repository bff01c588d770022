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
    """The tangent space of constraints of full rank, with J = A ⊗ Id_m for a sparse A.

    Raises
    ------
    numpy.linalg.LinAlgError
        If the system is singular.
    """

    def __init__(self, gram: sp.csr_array, constraints: ConstraintDerivative) -> None:
        super().__init__(constraints)
        self._gram = gram
        n, m = constraints.shape
        lengths = constraints.length_rows()
        self._factor = factorised(sp.block_array([[sp.kron(gram, sp.eye_array(m)), lengths.T], [lengths, None]]))
        border = np.reshape(list(constraints.barycenter_rows()), (-1, n * m))
        self._border = np.hstack([border, np.zeros((len(border), lengths.shape[0]))])
        self._response = self._factor.solve(self._border.T)
        self._pinned = self._border @ self._response

    def solve(self, eta: FloatArray | None, xi: FloatArray | None) -> tuple[FloatArray, FloatArray]:
        """Solve without barycenters, then pin these."""
        n, m = self.constraints.shape
        edges = len(self.constraints.tangents)
        eta = np.zeros((n, m)) if eta is None else eta
        xi = np.zeros(self.constraints.count) if xi is None else xi
        free = self._factor.solve(np.concatenate([eta.ravel(), xi[:edges]]))
        pull = np.linalg.solve(self._pinned, self._border @ free - xi[edges:])
        both = free - self._response @ pull
        return both[: n * m].reshape(n, m), np.concatenate([both[n * m :], pull])

    def apply(self, u: FloatArray) -> FloatArray:
        """J u."""
        return np.asarray(self._gram @ u)


class SparseWholeSpace(WholeSpace):
    """The whole space with J + Cᵀ w C, which is sparse too."""

    def __init__(self, gram: sp.csr_array, constraints: ConstraintDerivative, weights: FloatArray) -> None:
        super().__init__(constraints, weights)
        lengths = constraints.length_rows()
        full = sp.kron(gram, sp.eye_array(constraints.shape[1]))
        self._matrix = sp.csr_array(full + lengths.T @ sp.diags_array(weights) @ lengths)
        self._factor = factorised(self._matrix)

    def riesz(self, eta: FloatArray) -> FloatArray:
        """By the factorisation."""
        return np.asarray(self._factor.solve(eta.ravel())).reshape(eta.shape)

    def apply(self, u: FloatArray) -> FloatArray:
        """(J + Cᵀ w C) u."""
        return np.asarray(self._matrix @ u.ravel()).reshape(u.shape)


def factorised(matrix: sp.sparray) -> SuperLU:
    """LU factors; a LinAlgError says if there are none."""
    try:
        return splu(sp.csc_array(matrix))
    except RuntimeError as error:  # SuperLU's word for a singular matrix
        raise np.linalg.LinAlgError(f"matrix is singular: {error}") from error
