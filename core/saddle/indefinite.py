"""The saddle-point system (41) of [RS21] with a second derivative in place of the metric, factorised as a whole.

Bunch and Kaufman's factors tell the inertia too: on ker C a symmetric H has as many negative eigenvalues as
[[H, Cᵀ], [C, 0]] has beyond one for each of C's rows (Gould, On practical conditions for the existence and uniqueness
of solutions to the general equality quadratic programming problem, Math. Programming 32, 1985).
"""

import numpy as np
from scipy.linalg import lapack

from ..constraints import ConstraintDerivative
from ..types import FloatArray


class FactorisedHessian:
    """A symmetric H, shape (n·m, n·m), on the tangent space of constraints; LinAlgError if it is singular there."""

    def __init__(self, matrix: FloatArray, constraints: ConstraintDerivative) -> None:
        self._constraints, size = constraints, len(matrix)
        system = np.zeros((size + constraints.count,) * 2, order="F")
        system[:size, :size] = matrix
        lengths = constraints.length_rows()
        system[size : size + lengths.shape[0], :size] = lengths.toarray()
        for row, border in zip(system[size + lengths.shape[0] :], constraints.border(), strict=True):
            row[:size] = border.ravel()
        held = self._held
        system[held], system[:, held] = 0.0, 0.0
        system[held, held] = 1.0
        work = int(lapack.dsytrf_lwork(len(system), lower=1)[0].real)
        self._factor, self._pivots, info = lapack.dsytrf(system, lower=1, lwork=work, overwrite_a=1)
        if info != 0:
            raise np.linalg.LinAlgError(f"second derivative is singular: pivot {info} of {len(system)}")

    @property
    def negative(self) -> int:
        """Number of H's negative eigenvalues on ker C; a pivot of two rows has one of each sign."""
        single = self._pivots > 0
        pairs = np.count_nonzero(~single) // 2
        return int(np.count_nonzero(np.diag(self._factor)[single] < 0.0) + pairs - self._constraints.count)

    def solve(self, force: FloatArray) -> FloatArray:
        """The tangent u for which H u and the force agree on tangent vectors; both of shape (n, m)."""
        right = np.zeros((len(self._factor), 1))
        right[: force.size, 0] = force.ravel()
        right[self._held] = 0.0
        solution = lapack.dsytrs(self._factor, self._pivots, right, lower=1, overwrite_b=1)[0]
        return np.asarray(solution[: force.size].reshape(force.shape))

    @property
    def _held(self) -> FloatArray:
        """The unknowns of pinned vertices."""
        dimension = self._constraints.shape[1]
        return np.add.outer(dimension * self._constraints.pins, np.arange(dimension)).ravel()
