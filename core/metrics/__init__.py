"""Metrics: inner products on functions along the curve, one Gram matrix A of shape (n, n) each."""

from collections.abc import Mapping
from types import MappingProxyType

from .fractional import FractionalMetric
from .local import H1Metric, H2Metric, L2Metric
from .moebius import MoebiusMetric
from .protocol import Metric

METRICS: Mapping[str, Metric] = MappingProxyType(
    {metric.name: metric for metric in (L2Metric(), H1Metric(), FractionalMetric(), H2Metric(), MoebiusMetric())}
)

__all__ = ["METRICS", "FractionalMetric", "H1Metric", "H2Metric", "L2Metric", "Metric", "MoebiusMetric"]
