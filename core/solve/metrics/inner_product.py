"""Inner products on functions along a curve, as operators: what is done with a Gram matrix A, and how.

On R^m-valued functions they act coordinate by coordinate, J = A ⊗ Id_m.
"""

from typing import ClassVar, Protocol, runtime_checkable

import numpy as np
import scipy.sparse as sp
from scipy.linalg import lapack

from ...base import FloatArray, IntArray, checked
from ...curve import Curve
from ...energies import Rule
from ..constraints import ConstraintDerivative
from ..saddle import TangentSpace
from ..saddle.tangent_space import DenseTangentSpace, SparseTangentSpace, cholesky, symmetric_product


@runtime_checkable
class InnerProduct(Protocol):
    """⟨u, v⟩ = Σ u A v, A symmetric and positive definite, for functions on n vertices."""

    def apply(self, u: FloatArray) -> FloatArray:
        """A u; shape (n, k)."""

    def plus(self, other: "SparseInnerProduct") -> "InnerProduct":
        """⟨u, v⟩ + ⟨u, v⟩_other."""

    def dense(self) -> FloatArray:
        """A, shape (n, n), for tests and for other dense matrices."""

    def tangent_space(self, constraints: ConstraintDerivative, weights: FloatArray | None = None) -> TangentSpace:
        """The tangent space of constraints with this inner product, or with weights the whole space."""


class DenseInnerProduct:
    """A as an array (n, n), of which only the lower triangle counts."""

    most_rows: ClassVar[int] = 12_000  # some six such matrices make 7 GB

    @checked
    def __init__(self, matrix: FloatArray) -> None:
        self._matrix = np.asfortranarray(matrix)
        self._inverse: tuple[IntArray, FloatArray] | None = None  # kept, as a metric outlives tangent spaces

    def apply(self, u: FloatArray) -> FloatArray:
        return symmetric_product(self._matrix, u)

    def plus(self, other: "SparseInnerProduct") -> InnerProduct:
        matrix, more = self._matrix.copy(order="F"), other.matrix.tocoo()
        np.add.at(matrix, more.coords, more.data)
        return DenseInnerProduct(matrix)

    def dense(self) -> FloatArray:
        return _filled(self._matrix.copy(order="F"))

    def tangent_space(self, constraints: ConstraintDerivative, weights: FloatArray | None = None) -> TangentSpace:
        pins = constraints.pins
        if self._inverse is None or not np.array_equal(pins, self._inverse[0]):
            self._inverse = pins, self._inverted(pins)
        return DenseTangentSpace(self._matrix, self._inverse[1], constraints, weights)

    def _inverted(self, pins: IntArray) -> FloatArray:
        """A⁻¹ of functions that vanish at pins, in full, continued by 0."""
        matrix = self._matrix.copy(order="F")
        matrix[pins], matrix[:, pins] = 0.0, 0.0
        matrix[pins, pins] = 1.0
        inverse, info = lapack.dpotri(cholesky(matrix), lower=1, overwrite_c=1)
        if info != 0:
            raise np.linalg.LinAlgError(f"matrix is singular: pivot {info} of {len(self._matrix)}")
        filled = _filled(np.asarray(inverse))
        filled[pins, pins] = 0.0
        return filled


class SparseInnerProduct:
    """A as a sparse matrix of few entries a row; ``matrix`` has it in compressed rows."""

    most_rows: ClassVar[int] = 50_000  # energies, sums over all pairs of edges, take half a minute there

    @checked
    def __init__(self, matrix: sp.sparray) -> None:
        self.matrix = sp.csr_array(matrix)

    def apply(self, u: FloatArray) -> FloatArray:
        return np.asarray(self.matrix @ u)

    def plus(self, other: "SparseInnerProduct") -> InnerProduct:
        return SparseInnerProduct(self.matrix + other.matrix)

    def dense(self) -> FloatArray:
        return np.asarray(self.matrix.toarray())

    def tangent_space(self, constraints: ConstraintDerivative, weights: FloatArray | None = None) -> TangentSpace:
        return SparseTangentSpace(self.matrix, constraints, weights)


def _filled(lower: FloatArray) -> FloatArray:
    """A symmetric matrix in Fortran order, of which only the lower half was given, in full."""
    block = 128
    for first in range(0, len(lower), block):
        last = first + block
        diagonal = lower[first:last, first:last]
        diagonal[...] = np.tril(diagonal) + np.tril(diagonal, -1).T
        lower[first:last, last:] = lower[last:, first:last].T
    return lower


@runtime_checkable
class Metric(Protocol):
    """An inner product on functions along the curve; on R^m-valued ones it acts coordinate by coordinate."""

    @property
    def name(self) -> str:
        """Name in the registry."""

    @property
    def description(self) -> str:
        """The space, in mathematicians' notation."""

    @property
    def extends_penalty(self) -> bool:
        """Whether penalised methods add the lengths' part to it (footnote 8 of [RS21])."""

    @property
    def most_vertices(self) -> int:
        """Number of vertices up to which its inner products fit into memory."""

    @property
    def rule(self) -> Rule | None:
        """The quadrature rule for pairs of edges; None if there is nothing to choose."""

    def with_rule(self, rule: Rule) -> "Metric":
        """The same metric by another rule; itself if there is nothing to choose."""

    def at(self, curve: Curve) -> InnerProduct:
        """The inner product on functions along a curve of at most so many vertices."""
