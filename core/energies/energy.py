"""What the program asks of an energy."""

from typing import Protocol, runtime_checkable

from ..curve import Curve
from ..curve.tiles import EdgePairIndices
from ..quadrature import Rule
from ..types import FloatArray


@runtime_checkable
class Energy(Protocol):
    """A differentiable function of the vertices, invariant under rigid motions."""

    @property
    def name(self) -> str:
        """The name that users choose it by."""

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

    def value(self, curve: Curve) -> float:
        """The energy of the curve."""

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        """The energy and its derivative with respect to the vertices, shape (n, m)."""


class WithMidpointPairs(Energy, Protocol):
    """An energy part of which the barrier replaces."""

    def leaving_out(self, pairs: EdgePairIndices) -> Energy:
        """The same without some pairs of edges."""


@runtime_checkable
class Approximate(Energy, Protocol):
    """An energy that is approximated in a way that depends on the curve, and is smooth only as long as that is kept."""

    def frozen_at(self, curve: Curve) -> Energy:
        """The smooth function that the way for one curve makes of it."""


class TwiceDifferentiable(Energy, Protocol):
    """An energy with a second derivative, for Newton's method."""

    def hessian(self, curve: Curve) -> FloatArray:
        """D²E, symmetric, shape (n·m, n·m); rows and columns in the order of ``vertices.ravel()``."""

    def hessian_product(self, curve: Curve, v: FloatArray) -> FloatArray:
        """D²E v for a vector ``v`` of shape (n, m), without forming the matrix; shape (n, m)."""
