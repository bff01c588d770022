"""Which panels of a curve see which simplices one by one, which of them in clusters, and by how many Gauss points.

Panels are halved until the potential is analytic so far around them that few points are enough.  That follows all
singularities wherever they are, with a number of panels that grows like the logarithm of their distance only.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...curve import Curve
from ...types import BoolArray, FloatArray
from .clusters import Clusters
from .panels import MAX_POINTS, Edges, Panels, least_ratios
from .vectors import norm

EXACT = least_ratios(20.0)  # 2e-9
CLUSTERED = least_ratios(8.0)  # 3e-4, still less than what moments leave
SHORTEST = 2.0**-48  # of an edge: not even contact makes panels shorter
CHUNK = 1024  # edges looked at together, to bound the memory


class Group(NamedTuple):
    """Panels that are integrated by equally many Gauss points."""

    points: int
    panels: Panels


@dataclass(frozen=True, eq=False)
class Schedule:
    """Every pair of an edge and a simplex exactly once, but for the panels that edges are cut into.

    Attributes
    ----------
    curve
        The curve that it was made for.
    single
        Panels that see simplices.
    clustered
        Panels that see clusters: those with (radius of the cluster + half length) < θ (distance of the centres).
    theta
        The separation parameter θ.
    """

    curve: Curve
    single: tuple[Group, ...]
    clustered: tuple[Group, ...]
    theta: float

    @classmethod
    def of(cls, curve: Curve, clusters: Clusters, theta: float) -> "Schedule":
        """That of a curve in R³."""
        edges, every = Edges.of(curve.mesh, curve.vertices), np.arange(curve.mesh.edges)
        chunks = [every[first : first + CHUNK] for first in range(0, len(every), CHUNK)]
        found = [_traverse(Panels.whole(chunk), edges, clusters, theta) for chunk in chunks]
        single, clustered = (Panels.joined(list(kind)) for kind in zip(*found, strict=True))
        return cls(
            curve,
            _grouped(single, _analytic_ratios(single, edges, clusters), EXACT),
            _grouped(clustered, _clear_ratios(clustered, edges, clusters), CLUSTERED),
            theta,
        )

    def suits(self, curve: Curve, clusters: Clusters, slack: float) -> bool:
        """Whether another curve can be integrated by it, if radii and distances may be that factor ≤ 1 too small."""
        if curve.mesh != self.curve.mesh:
            return False
        if np.array_equal(curve.vertices, self.curve.vertices):
            return True
        edges = Edges.of(curve.mesh, curve.vertices)
        return all(
            np.all(_analytic_ratios(panels, edges, clusters) >= slack * EXACT[points - 1])
            for points, panels in self.single
        ) and all(np.all(_are_far(panels, edges, clusters, self.theta / slack)) for _, panels in self.clustered)


def _traverse(panels: Panels, edges: Edges, clusters: Clusters, theta: float) -> tuple[Panels, Panels]:
    """Panels that see simplices and panels that see clusters, from whole edges that see the root."""
    single, clustered = [], []
    while len(panels):
        far = _are_far(panels, edges, clusters, theta)
        clustered.append(panels[far])
        panels = panels[~far]
        leaf = clusters.child[panels.source] == 0
        seen = panels[leaf].seeing(clusters.simplex[panels.source[leaf]])
        fine = (_analytic_ratios(seen, edges, clusters) >= EXACT[-1]) | (seen.width <= SHORTEST)
        single.append(seen[fine])
        left = np.ones(len(panels), dtype=bool)
        left[leaf] = ~fine
        panels = _split(panels[left], edges, clusters)
    return Panels.joined(single), Panels.joined(clustered)


def _split(panels: Panels, edges: Edges, clusters: Clusters) -> Panels:
    """Each panel with both children of the cluster it sees, or both of its halves if these are larger."""
    child = clusters.child[panels.source]
    opened = (child > 0) & (clusters.radius[panels.source] >= panels.half_lengths(edges))
    same, child = panels[opened], child[opened]
    return Panels.joined([same.seeing(child), same.seeing(child + 1), panels[~opened].halved()])


def _grouped(panels: Panels, ratio: FloatArray, least: FloatArray) -> tuple[Group, ...]:
    """The panels by the number of points that they need."""
    points = np.minimum(np.searchsorted(-least, -ratio) + 1, MAX_POINTS)
    return tuple(Group(k, panels[points == k]) for k in np.unique(points).tolist())


def _analytic_ratios(panels: Panels, edges: Edges, clusters: Clusters) -> FloatArray:
    """Analytic radius to half length, for panels that see simplices."""
    tau = edges.vector[:, panels.edge] / edges.length[panels.edge]
    reach = clusters.simplices.reach(panels.source, panels.middles(edges), tau)
    return np.asarray(reach / panels.half_lengths(edges))


def _clear_ratios(panels: Panels, edges: Edges, clusters: Clusters) -> FloatArray:
    """Distance from the cluster to half length, for panels that see clusters."""
    clear = _distances(panels, edges, clusters) - clusters.radius[panels.source]
    return np.asarray(clear / panels.half_lengths(edges))


def _are_far(panels: Panels, edges: Edges, clusters: Clusters, theta: float) -> BoolArray:
    """Whether the clusters that panels see may count by their moments."""
    extent = clusters.radius[panels.source] + panels.half_lengths(edges)
    return np.asarray(extent < theta * _distances(panels, edges, clusters))


def _distances(panels: Panels, edges: Edges, clusters: Clusters) -> FloatArray:
    return norm(panels.middles(edges) - clusters.centre[:, panels.source])
