"""Sums over all pairs of edges in O(N log N): clusters of edges, and pairs of clusters that see each other as one."""

from .blocks import BlockList
from .clusters import ClusterTree
from .energy import HierarchicalMoebiusEnergy, moebius_energy
from .metric import CompressedMetric, compressed

__all__ = ["BlockList", "ClusterTree", "CompressedMetric", "HierarchicalMoebiusEnergy", "compressed", "moebius_energy"]
