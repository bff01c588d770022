"""What a metric is."""

from typing import Protocol

from ..curve import Curve
from ..types import FloatArray


class Metric(Protocol):
    """An inner product on functions along the curve; on R^m-valued ones it acts coordinate by coordinate."""

    @property
    def name(self) -> str:
        """Name in the registry."""

    @property
    def description(self) -> str:
        """The space, in mathematicians' notation."""

    def matrix(self, curve: Curve) -> FloatArray:
        """Gram matrix A, symmetric positive definite, shape (n, n)."""
