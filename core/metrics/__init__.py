"""Metrics: inner products on functions along the curve."""

from collections.abc import Mapping
from types import MappingProxyType

from .inner_product import DenseInnerProduct, InnerProduct, Metric, SparseInnerProduct
from .local import H1, H2, L2, WithoutRule
from .moebius import FractionalMetric, MoebiusMetric

METRICS: Mapping[str, Metric] = MappingProxyType(
    {
        metric.name: metric
        for metric in (
            L2,
            H1,
            FractionalMetric(),
            H2,
            MoebiusMetric(),
        )
    }
)
"""Every metric that users can choose, by name."""

__all__ = [
    "METRICS",
    "DenseInnerProduct",
    "FractionalMetric",
    "InnerProduct",
    "Metric",
    "MoebiusMetric",
    "SparseInnerProduct",
    "WithoutRule",
]
