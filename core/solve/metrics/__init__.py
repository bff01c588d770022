"""Metrics: inner products on functions along the curve."""

from collections.abc import Mapping

from .inner_product import DenseInnerProduct, InnerProduct, Metric, SparseInnerProduct
from .local import H1Metric, H2Metric, L2Metric, WithoutRule
from .moebius import FractionalMetric, MoebiusMetric

METRICS: Mapping[str, Metric] = {
    metric.name: metric
    for metric in (
        L2Metric(),
        H1Metric(),
        FractionalMetric(),
        H2Metric(),
        MoebiusMetric(),
    )
}
"""Every metric that users can choose, by name."""
