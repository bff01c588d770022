"""Minimum or saddle: the Lagrangian's Hessian on the tangent space of the constraints."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh, qr

from ..constraints import ConstraintDerivative
from ..curve.pins import holds
from ..descent import Point
from ..descent.directions.newton import lagrangian_hessian_matrix
from ..types import FloatArray

ZERO = 1e-5  # eigenvalues against J_C below this count as 0: rotations and sliding are flat directions


@dataclass(frozen=True, eq=False)
class Stability:
    """Second-order information at a critical point.

    Attributes
    ----------
    eigenvalues
        The lowest eigenvalues against the metric, in ascending order; shape (k,).
    directions
        Their eigenvectors, tangent and of length 1 in the metric; shape (k, n, m).
    """

    eigenvalues: FloatArray
    directions: FloatArray

    @property
    def index(self) -> int:
        """Number of negative eigenvalues: 0 at a minimum, more at a saddle."""
        return int(np.count_nonzero(self.eigenvalues < -ZERO))


def stability(point: Point, count: int = 20) -> Stability:
    """The lowest ``count`` eigenvalues of D²E − Σ λ_I D²Φ_I on ker DΦ, against the metric.

    Dense: O((n m)³) operations and O((n m)²) memory.
    """
    n, m = point.vertices.shape
    tangent = _tangent_basis(point.tangent_space.constraints)
    if not tangent.size:  # pins leave nothing to move
        return Stability(np.empty(0), np.empty((0, n, m)))
    hessian = tangent.T @ lagrangian_hessian_matrix(point) @ tangent
    # the metric acts coordinate by coordinate, on all basis vectors at once
    gram = tangent.T @ point.tangent_space.apply(tangent.reshape(n, -1)).reshape(tangent.shape)
    last = min(count, len(gram)) - 1
    values, vectors = eigh(0.5 * (hessian + hessian.T), 0.5 * (gram + gram.T), subset_by_index=(0, last))
    return Stability(values, np.ascontiguousarray((tangent @ vectors).T).reshape(-1, n, m))


def _tangent_basis(constraints: ConstraintDerivative) -> FloatArray:
    """Orthonormal basis of ker DΦ, 0 at pins, as columns; shape (n·m, unknowns that are free less the rows of DΦ)."""
    (n, m), count, free = constraints.shape, constraints.count, ~holds(constraints.mesh, constraints.pins)
    size = m * np.count_nonzero(free) - count
    basis = np.zeros((n, m, size))
    if size:
        rows = [constraints.apply_transpose(unit)[free].ravel() for unit in np.eye(count)]
        basis[free] = qr(np.stack(rows, axis=1))[0][:, count:].reshape(-1, m, size)
    return basis.reshape(n * m, size)
