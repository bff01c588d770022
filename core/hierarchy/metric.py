"""The nonlocal metrics for curves of many vertices."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from ..curve import Curve
from ..errors import OptionError
from ..metrics import FractionalMetric, InnerProduct, Metric, MoebiusMetric
from ..quadrature import MIDPOINT, Rule
from ..saddle.iterative import Tolerances
from .inner_product import CompressedInnerProduct, fractional_inner_product, moebius_inner_product

MAX_VERTICES = 200_000  # some 3 GB, and half a minute a step

_COMPRESSED: Mapping[type, Callable[[Curve, Tolerances | None], CompressedInnerProduct]] = MappingProxyType(
    {MoebiusMetric: moebius_inner_product, FractionalMetric: fractional_inner_product}
)


@dataclass(frozen=True)
class CompressedMetric:
    """One of the nonlocal metrics by products in O(N log N), with the midpoint rule.

    Parameters
    ----------
    metric
        The dense one.
    tolerances
        Of what is solved with it.
    """

    metric: Metric
    tolerances: Tolerances = field(default_factory=Tolerances)
    most_vertices = MAX_VERTICES

    @property
    def name(self) -> str:
        """That of the dense one."""
        return self.metric.name

    @property
    def description(self) -> str:
        """That of the dense one."""
        return self.metric.description

    @property
    def extends_penalty(self) -> bool:
        """As for the dense one."""
        return self.metric.extends_penalty

    @property
    def rule(self) -> Rule | None:
        """The midpoint rule, or none."""
        return self.metric.rule

    def with_rule(self, rule: Rule) -> "CompressedMetric":
        """Itself: there is no other rule.

        Raises
        ------
        OptionError
            If another rule is asked for.
        """
        if self.rule is not None and rule != MIDPOINT:
            raise OptionError("metrics for so many vertices use one Gauss point per edge; leave quadrature_points out")
        return self

    def at(self, curve: Curve) -> InnerProduct:
        """The inner product on functions along a curve."""
        return _COMPRESSED[type(self.metric)](curve, self.tolerances)


def compressed(metric: Metric, tolerances: Tolerances) -> Metric:
    """A metric in the form for many vertices: local ones are sparse as they are."""
    return CompressedMetric(metric, tolerances) if type(metric) in _COMPRESSED else metric
