"""Sums over all pairs of edges in O(N log N): clusters of edges, and pairs of clusters that see each other as one."""

from .blocks import BlockList
from .clusters import ClusterTree
from .energy import HierarchicalMoebiusEnergy
from .metric import CompressedMetric, compressed
from .reported import moebius_energy
from .sampling import SampledErrors

__all__ = [
    "BlockList",
    "ClusterTree",
    "CompressedMetric",
    "HierarchicalMoebiusEnergy",
    "SampledErrors",
    "compressed",
    "moebius_energy",
]
