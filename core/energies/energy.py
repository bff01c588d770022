"""The interfaces that the program requires of an energy."""

from typing import Protocol, runtime_checkable

import scipy.sparse as sp

from ..base import FloatArray
from ..curve import Curve
from .quadrature import Rule


@runtime_checkable
class Term(Protocol):
    """A differentiable function of the vertices: an energy, or another term of an objective."""

    @property
    def name(self) -> str:
        """Its name."""

    def value(self, curve: Curve) -> float:
        """The term at the curve."""

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        """The term and its derivative with respect to the vertices, shape (n, m)."""


@runtime_checkable
class TwiceDifferentiable(Term, Protocol):
    """A term with a second derivative, for methods of second order and for the index of a critical point."""

    def hessian_product(self, curve: Curve, v: FloatArray) -> FloatArray:
        """D²E v for a vector ``v`` of shape (n, m), without forming the matrix; shape (n, m)."""


@runtime_checkable
class LocalTerm(TwiceDifferentiable, Protocol):
    """A term whose second derivative couples few vertices with each other."""

    def sparse_hessian(self, curve: Curve) -> sp.csr_array:
        """The second derivative as a sparse matrix, in the same order."""


@runtime_checkable
class Stiff(Term, Protocol):
    """A term that the energy's metric does not account for, so that steps would be too long for it."""

    def stiffness(self, curve: Curve) -> sp.sparray:
        """A quadratic form on functions along the curve, of about the size of the second derivative; shape (n, n)."""


def scale_exponent(term: object) -> float | None:
    """s of E(λ P) = λˢ E(P), 0 for terms that do not depend on size; None for a term that does not say."""
    exponent = getattr(term, "scale_exponent", None)
    return None if exponent is None else float(exponent)


def is_moebius_invariant(term: object) -> bool:
    """Whether a term declares itself invariant under Möbius maps, up to the effects of the mesh."""
    return bool(getattr(term, "moebius_invariant", False))


@runtime_checkable
class Energy(Term, Protocol):
    """A term that is invariant under rigid motions; users choose it by its name."""

    @property
    def description(self) -> str:
        """One line for lists."""

    @property
    def rule(self) -> Rule:
        """Where on the edges it is evaluated; J_C uses the same places unless told otherwise."""

    @property
    def scale_exponent(self) -> float:
        """s of E(λ P) = λˢ E(P); 0 for energies that do not depend on size."""

    @property
    def contains_midpoint_pairs(self) -> bool:
        """Whether it contains the midpoint energies that the barrier replaces; then it has `leaving_out`."""


@runtime_checkable
class Approximate(Term, Protocol):
    """A term approximated in a way that depends on the curve, and smooth only while that way is kept."""

    def frozen_at(self, curve: Curve) -> Term:
        """The smooth function given by the approximation for one curve."""
