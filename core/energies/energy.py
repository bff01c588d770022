"""What the program asks of an energy."""

from typing import Protocol

from ..curve import Curve
from ..types import FloatArray


class Energy(Protocol):
    """A differentiable function of the vertices, invariant under rigid motions."""

    @property
    def name(self) -> str:
        """The name that users choose it by."""

    @property
    def description(self) -> str:
        """One line for lists."""

    def value(self, curve: Curve) -> float:
        """The energy of the curve."""

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        """The energy and its derivative with respect to the vertices, shape (n, m)."""


class TwiceDifferentiable(Energy, Protocol):
    """An energy with a second derivative, for Newton's method."""

    def hessian(self, curve: Curve) -> FloatArray:
        """D²E, symmetric, shape (n·m, n·m); rows and columns in the order of ``vertices.ravel()``."""

    def hessian_product(self, curve: Curve, v: FloatArray) -> FloatArray:
        """D²E v for a vector ``v`` of shape (n, m), without forming the matrix; shape (n, m)."""
