"""Sums over all pairs of edges in O(N log N): clusters of edges, and pairs of clusters that see each other as one."""

from .blocks import BlockList
from .energy import HierarchicalMoebiusEnergy, SampledErrors, moebius_energy
