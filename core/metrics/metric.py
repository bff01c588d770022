"""What a metric is."""

from typing import Protocol, runtime_checkable

from ..curve import Curve
from ..quadrature import Rule
from .inner_product import InnerProduct


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
