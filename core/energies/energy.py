"""What the program asks of an energy."""

from typing import Protocol, runtime_checkable

import scipy.sparse as sp

from ..curve import Curve
from ..quadrature import Rule
from ..types import FloatArray
from .edge_pairs import EdgePairIndices


@runtime_checkable
class Term(Protocol):
    """A differentiable function of the vertices: an energy, or what an objective has beside it."""

    @property
    def name(self) -> str:
        """What it is called."""

    def value(self, curve: Curve) -> float:
        """The term at the curve."""

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        """The term and its derivative with respect to the vertices, shape (n, m)."""


@runtime_checkable
class LocalTerm(Term, Protocol):
    """A term whose second derivative couples few vertices with each other."""

    def sparse_hessian(self, curve: Curve) -> sp.csr_array:
        """Second derivative as a sparse matrix, symmetric, shape (n·m, n·m), in the order of ``vertices.ravel()``."""

    def hessian_product(self, curve: Curve, v: FloatArray) -> FloatArray:
        """The second derivative times a vector ``v`` of shape (n, m), without forming the matrix; shape (n, m)."""


@runtime_checkable
class Stiff(Term, Protocol):
    """A term that the metric of the energy does not see, so that steps would be too long for it."""

    def stiffness(self, curve: Curve) -> sp.sparray:
        """A quadratic form on functions along the curve, of about the size of the second derivative; shape (n, n)."""


@runtime_checkable
class Confining(Term, Protocol):
    """A term of what stands around the curve."""

    def clearance(self, curve: Curve) -> FloatArray:
        """How far from each edge a wall would be that acts on it as strongly; shape (edges,)."""


def scale_exponent(term: object) -> float | None:
    """s of E(λ P) = λˢ E(P), 0 for terms that do not see size; None where a term does not say."""
    exponent = getattr(term, "scale_exponent", None)
    return None if exponent is None else float(exponent)


def is_moebius_invariant(term: object) -> bool:
    """Whether a term says that Möbius maps change nothing of it, but for what the mesh makes of that."""
    return bool(getattr(term, "moebius_invariant", False))


@runtime_checkable
class Energy(Term, Protocol):
    """A term that is invariant under rigid motions; users choose it by its name."""

    @property
    def description(self) -> str:
        """One line for lists."""

    @property
    def rule(self) -> Rule:
        """Where on the edges it looks; J_C looks at the same places unless told otherwise."""

    @property
    def scale_exponent(self) -> float:
        """s of E(λ P) = λˢ E(P); 0 for energies that do not see size."""

    @property
    def contains_midpoint_pairs(self) -> bool:
        """Whether the midpoint energies that the barrier replaces are part of it; then it has `leaving_out`."""


class WithMidpointPairs(Energy, Protocol):
    """An energy part of which the barrier replaces."""

    def leaving_out(self, pairs: EdgePairIndices) -> Energy:
        """The same without some pairs of edges."""


@runtime_checkable
class Approximate(Term, Protocol):
    """A term that is approximated in a way that depends on the curve, and is smooth only as long as that is kept."""

    def frozen_at(self, curve: Curve) -> Term:
        """The smooth function that the way for one curve makes of it."""


class TwiceDifferentiable(Energy, Protocol):
    """An energy with a second derivative, for Newton's method."""

    def hessian(self, curve: Curve) -> FloatArray:
        """D²E, symmetric, shape (n·m, n·m); rows and columns in the order of ``vertices.ravel()``."""

    def hessian_product(self, curve: Curve, v: FloatArray) -> FloatArray:
        """D²E v for a vector ``v`` of shape (n, m), without forming the matrix; shape (n, m)."""
