"""Soft modes: tangent directions in which the Lagrangian's Hessian is least against the metric, by products alone.

J_C⁻¹ D²L is an operator of order 0: on every mesh all but a few of its eigenvalues lie in a bulk, from some 0.2 to 2, so
that 100 to 200 products find those below it, for any number of vertices.  This is Davidson's method in blocks: the
basis grows by the residuals of the lowest Ritz pairs, projected to the tangent space in the metric.  With exact
projections it is the block Lanczos method; loose ones, such as those of `saddle.iterative`, do no harm.

SciPy's solvers do not serve: ARPACK's may miss copies of multiple eigenvalues, which symmetric knots have; `lobpcg`
takes forces normal to the constraints for errors, and solves small problems in the whole space.
"""

from dataclasses import dataclass

import numpy as np

from ..types import FloatArray
from .hessian import LinearMap, lagrangian_hessian
from .problem import Point

BULK = 0.1  # against J_C: flat and soft directions of knots are below, all others above
ROUNDING = 1e-10  # relative to the largest Ritz value: residuals so short are rounding errors
DEPENDENT = 1e-10  # of squared lengths: vectors that add so little to the others are left out


@dataclass(frozen=True, eq=False)
class SoftModes:
    """Ritz pairs of J⁻¹(D²E − Σ λ_I D²Φ_I) on ker DΦ, in ascending order.

    Attributes
    ----------
    values
        Ritz values θ, each at least the eigenvalue in its place; shape (k,).
    vectors
        Ritz vectors w, tangent and orthonormal in the metric; shape (k, n, m).
    residuals
        Norms of the projected J⁻¹ D²L w − θ w in the metric, within which of θ there is an eigenvalue; shape (k,).
    """

    values: FloatArray
    vectors: FloatArray
    residuals: FloatArray


def soft_modes(
    point: Point,
    rng: np.random.Generator,
    tolerance: float = 1e-6,
    below: float = BULK,
    most: int = 400,
    block: int = 8,
) -> SoftModes:
    """The ``block`` lowest Ritz pairs, from random starts, or all below a bound if these are more.

    Parameters
    ----------
    point
        Where, in the metric J_C or one as strong.
    rng
        For the starts.
    tolerance
        Residual at which those less than ``below``, and the lowest one, are near enough to eigenvalues.
    most
        Number of products with the Hessian and of projections, at which the pairs are given as they are.
    block
        Number of starts: so many copies of a multiple eigenvalue can be found.
    """
    basis, shape = _Basis(point), point.vertices.shape
    room = most = min(most, basis.dimension)
    new = basis.riesz(rng.normal(size=(min(block, most), point.vertices.size)))
    while True:
        basis.extend(new)
        values, vectors, forces = basis.lowest(block, below)
        new = basis.riesz(forces)
        residuals = np.sqrt(np.maximum(0.0, np.einsum("ij,ij->i", new, forces)))
        far = residuals > max(tolerance, ROUNDING * basis.scale)
        room = most - len(basis)
        if room <= 0 or not far[: max(1, np.count_nonzero(values < below))].any():
            return SoftModes(values, vectors.reshape(-1, *shape), residuals)
        new = (new[far] / residuals[far, None])[:room]


class _Basis:
    """A basis of a subspace of the tangent space, orthonormal in the metric, and its images; rows of n·m numbers."""

    def __init__(self, point: Point) -> None:
        self._space, self._hessian = point.tangent_space, lagrangian_hessian(point)
        self._shape = point.vertices.shape
        self._vectors, self._duals, self._images = np.empty((3, 0, point.vertices.size))
        self.scale = 0.0  # the largest Ritz value

    def __len__(self) -> int:
        return len(self._vectors)

    @property
    def dimension(self) -> int:
        """That of the tangent space."""
        n, m = self._shape
        return m * (n - len(self._space.constraints.pins)) - self._space.constraints.count

    def riesz(self, forces: FloatArray) -> FloatArray:
        """The tangent vectors that represent covectors in the metric."""
        return self._each(lambda force: self._space.gradient(force)[0], forces)

    def extend(self, new: FloatArray) -> None:
        """Add what tangent vectors of similar lengths have that the basis has not."""
        duals = self._each(self._space.apply, new)
        for _ in range(2):  # once leaves rounding errors
            part = new @ self._duals.T
            new, duals = new - part @ self._vectors, duals - part @ self._duals
            squares, turns = np.linalg.eigh(new @ duals.T)
            kept = squares > DEPENDENT * squares.max(initial=0.0)
            turn = (turns[:, kept] / np.sqrt(squares[kept])).T
            new, duals = turn @ new, turn @ duals
        self._vectors, self._duals = np.vstack([self._vectors, new]), np.vstack([self._duals, duals])
        self._images = np.vstack([self._images, self._each(self._hessian, new)])

    def lowest(self, count: int, below: float) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Ritz values, Ritz vectors and the forces that these leave: ``count`` of them, or as many as are below."""
        projected = self._vectors @ self._images.T
        values, turns = np.linalg.eigh(0.5 * (projected + projected.T))
        self.scale = float(np.abs(values).max(initial=0.0))
        values = values[: max(count, np.count_nonzero(values < below))]
        turns = turns[:, : len(values)].T
        return values, turns @ self._vectors, turns @ self._images - values[:, None] * (turns @ self._duals)

    def _each(self, operator: LinearMap, rows: FloatArray) -> FloatArray:
        return np.array([operator(row.reshape(self._shape)).ravel() for row in rows]).reshape(rows.shape)
