"""Minimum or saddle: the Lagrangian's Hessian on the tangent space of the constraints."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh, qr

from ..constraints import ConstraintDerivative
from ..curve import Curve
from ..curve.pins import holds
from ..descent import Point
from ..descent.directions.newton import lagrangian_hessian_matrix
from ..types import FloatArray

ZERO = 1e-5  # eigenvalues against J_C below this count as 0: rotations and sliding are flat directions
MOEBIUS = 20.0  # and so do Möbius maps on a mesh: in units of (h/L)², h the longest edge, they have 11 at most at knots


@dataclass(frozen=True, eq=False)
class Stability:
    """Second-order information at a critical point.

    Attributes
    ----------
    eigenvalues
        The lowest eigenvalues against the metric, in ascending order; shape (k,).
    directions
        Their eigenvectors, tangent and of length 1 in the metric; shape (k, n, m).
    zero
        Size up to which the mesh cannot tell an eigenvalue from 0.
    """

    eigenvalues: FloatArray
    directions: FloatArray
    zero: float = ZERO

    @property
    def index(self) -> int:
        """Number of negative eigenvalues: 0 at a minimum, more at a saddle."""
        return int(np.count_nonzero(self.eigenvalues < -self.zero))


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
    directions = np.ascontiguousarray((tangent @ vectors).T).reshape(-1, n, m)
    return Stability(values, directions, _unresolved(point.curve))


def _unresolved(curve: Curve) -> float:
    """Size of eigenvalues of Möbius maps, which change nothing of the energy but what the mesh makes of it."""
    ell = curve.edge_lengths
    return max(ZERO, MOEBIUS * max(float(ell[s].max() / ell[s].sum()) ** 2 for s in curve.mesh.edge_slices))


def _tangent_basis(constraints: ConstraintDerivative) -> FloatArray:
    """Orthonormal basis of ker DΦ, 0 at pins, as columns; shape (n·m, unknowns that are free less the rows of DΦ)."""
    (n, m), count, free = constraints.shape, constraints.count, ~holds(constraints.mesh, constraints.pins)
    size = m * np.count_nonzero(free) - count
    basis = np.zeros((n, m, size))
    if size:
        rows = [constraints.apply_transpose(unit)[free].ravel() for unit in np.eye(count)]
        basis[free] = qr(np.stack(rows, axis=1))[0][:, count:].reshape(-1, m, size)
    return basis.reshape(n * m, size)
