"""The saddle-point system (41) of [RS21] with a second derivative in place of the metric, factorised as a whole.

Along a chain of vertices a tangent vector is what it is at the first one and, edge by edge, a change normal to the
edge.  In these unknowns, two for an edge in space, all rows of lengths hold but those of edges that close a chain, and
the system has half the size.  Bunch and Kaufman's factors tell the inertia too: on ker R a symmetric A has as many
negative eigenvalues as [[A, Rᵀ], [R, 0]] has beyond one for each of R's rows (Gould, On practical conditions for the
existence and uniqueness of solutions to the general equality quadratic programming problem, Math. Programming 32,
1985).
"""

import numpy as np
import scipy.sparse as sp
from scipy.linalg import lapack

from ...base import FloatArray
from ..constraints import ConstraintDerivative


class Chains:
    """Displacements by unknowns t, shape (k,), that vanish at pins and change no length along chains.

    Chains begin at pins, and where components do.  ``rows`` of the constraints are left over, shape (r, k).
    """

    def __init__(self, constraints: ConstraintDerivative) -> None:
        mesh, (n, m) = constraints.mesh, constraints.shape
        starts = np.union1d(mesh.offsets[:-1], constraints.pins)
        self._shape, self._starts = (n, m), frozenset(starts.tolist())
        free = np.ones((n, m), dtype=bool)
        free[:, 0] = False  # along the edge
        free[starts] = True
        free[constraints.pins] = False
        # orthonormal frames, (n, m, m), whose first rows are along the edges: those of reflections
        vectors = constraints.tangents[mesh.incoming]
        mirror = vectors / np.linalg.norm(vectors, axis=1)[:, None]
        mirror[:, 0] += np.where(mirror[:, 0] < 0.0, -1.0, 1.0)
        squares = np.square(mirror).sum(axis=1)[:, None, None]
        frames = np.eye(m) - 2.0 * mirror[:, :, None] * mirror[:, None, :] / squares
        self._vertex, self._normals = np.nonzero(free)[0], frames[free]
        k, columns = len(self._vertex), m * self._vertex[:, None] + np.arange(m)
        self._basis = sp.csr_array((self._normals.ravel(), columns.ravel(), m * np.arange(k + 1)), shape=(k, n * m))
        closing = np.flatnonzero(np.isin(mesh.heads[constraints.edges], starts))
        left = np.eye(constraints.count)[[*closing, *range(len(constraints.edges), constraints.count)]]
        rows = [constraints.apply_transpose(row).ravel() for row in left]
        self.rows = self.of_forces(np.reshape(rows, (-1, n * m)).T).T

    def of_forces(self, forces: FloatArray) -> FloatArray:
        """Covectors, shape (n·m, c), in the unknowns; shape (k, c)."""
        return np.asarray(self._basis @ self._summed(forces.reshape(self._shape[0], -1)).reshape(forces.shape))

    def of_metric(self, gram: FloatArray) -> FloatArray:
        """A ⊗ Id_m for a symmetric A, shape (n, n), in the unknowns; shape (k, k)."""
        summed = self._summed(np.ascontiguousarray(self._summed(gram).T))
        return np.asarray((self._normals @ self._normals.T) * summed[np.ix_(self._vertex, self._vertex)])

    def displacement(self, t: FloatArray) -> FloatArray:
        """Shape (n, m)."""
        u = np.reshape(self._basis.T @ t, self._shape)
        for i in range(1, len(u)):
            if i not in self._starts:
                u[i] += u[i - 1]
        return u

    def _summed(self, forces: FloatArray) -> FloatArray:
        """For each vertex the sum of what acts on it and on those after it in its chain; shape (n, …)."""
        summed = forces.copy()
        for i in range(len(summed) - 1, 0, -1):
            if i not in self._starts:
                summed[i - 1] += summed[i]
        return summed


class FactorisedHessian:
    """A symmetric A, shape (k, k), in the unknowns of chains and where their rows are 0; LinAlgError if singular."""

    def __init__(self, matrix: FloatArray, chains: Chains) -> None:
        self._chains, size = chains, len(matrix)
        system = np.zeros((size + len(chains.rows),) * 2, order="F")
        system[:size, :size] = matrix
        system[size:, :size] = chains.rows
        work = int(lapack.dsytrf_lwork(len(system), lower=1)[0].real)
        self._factor, self._pivots, info = lapack.dsytrf(system, lower=1, lwork=work, overwrite_a=1)
        if info != 0:
            raise np.linalg.LinAlgError(f"second derivative is singular: pivot {info} of {len(system)}")

    @property
    def negative(self) -> int:
        """Number of negative eigenvalues; a pivot of two rows has one of each sign."""
        single = self._pivots > 0
        pairs = np.count_nonzero(~single) // 2
        return int(np.count_nonzero(np.diag(self._factor)[single] < 0.0) + pairs - len(self._chains.rows))

    def solve(self, force: FloatArray) -> FloatArray:
        """The tangent u for which A u and the force agree on tangent vectors; both of shape (n, m)."""
        right = np.zeros((len(self._factor), 1))
        own = self._chains.of_forces(force.reshape(-1, 1))
        right[: len(own)] = own
        solution = lapack.dsytrs(self._factor, self._pivots, right, lower=1, overwrite_b=1)[0]
        return self._chains.displacement(solution[: len(own), 0])
