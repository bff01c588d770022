"""Graded quadrature along edges: which panels see which simplices one by one, which clusters, by how many Gauss points.

Panels, dyadic parts of edges, are halved until the potential is analytic so far around them that few points are enough.
This follows all singularities wherever they are; the number of panels grows only like the logarithm of their distance.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...base.types import BoolArray, FloatArray, IntArray
from ...curve import Curve
from .simplices import Clusters, norm

Potential = Callable[[IntArray, FloatArray], tuple[FloatArray, FloatArray]]
"""Φ and ∇Φ of some simplices or clusters, shape (k,), each at its own points, shape (3, k, points)."""

MAX_POINTS = 8
# Ratios of analytic radius to half length from which 1, 2, … Gauss points leave an error of exp(−20) = 2e-9 for single
# simplices, and of exp(−8) = 3e-4 for clusters, still less than what moments leave: k points have the error ρ⁻²ᵏ, and
# the Bernstein ellipse lies within a disc of R half lengths if ρ + 1/ρ ≤ 2R.
EXACT, CLUSTERED = (np.cosh(exponent / (2.0 * np.arange(1, MAX_POINTS + 1))) for exponent in (20.0, 8.0))


@dataclass(frozen=True, eq=False)
class Panels:
    """Parts [begin, begin + width] of edges [0, 1], and the cluster or simplex that each of them sees; shapes (k,)."""

    edge: IntArray
    begin: FloatArray
    width: FloatArray
    source: IntArray

    def __len__(self) -> int:
        return len(self.edge)

    def __getitem__(self, choice: slice | BoolArray | IntArray) -> "Panels":
        return Panels(self.edge[choice], self.begin[choice], self.width[choice], self.source[choice])

    @classmethod
    def joined(cls, parts: "Sequence[Panels]") -> "Panels":
        return cls(*(np.concatenate([getattr(part, name) for part in parts]) for name in cls.__match_args__))

    def halves(self, curve: Curve) -> FloatArray:
        """Half of the panels' lengths."""
        return np.asarray(0.5 * self.width * curve.edge_lengths[self.edge])

    def middles(self, curve: Curve) -> FloatArray:
        """Their middles; shape (3, k)."""
        tails, vectors = curve.vertices[curve.mesh.tails].T, curve.edge_vectors.T
        return np.asarray(tails[:, self.edge] + (self.begin + 0.5 * self.width) * vectors[:, self.edge])


Groups = tuple[tuple[int, Panels], ...]
"""Numbers of Gauss points, and the panels that take so many, sorted by edge."""


@dataclass(frozen=True, eq=False)
class Schedule:
    """Each edge and simplex once, by panels, which see clusters if radius + half length < θ (distance of centers)."""

    curve: Curve  # the curve that it was made for
    single: Groups  # panels that see simplices
    clustered: Groups  # panels that see clusters
    theta: float  # the separation parameter θ

    @classmethod
    def of(cls, curve: Curve, clusters: Clusters, theta: float) -> "Schedule":
        """The schedule of a curve in R³."""
        tree, n, single, clustered = clusters.tree, curve.mesh.edges, list[Panels](), list[Panels]()
        for edges in np.array_split(np.arange(n), -(-n // 1024)):  # to bound the memory
            # from whole edges that see the root
            panels = Panels(edges, np.zeros(len(edges)), np.ones(len(edges)), np.zeros_like(edges))
            while len(panels):
                far = _are_far(curve, clusters, panels, theta)
                clustered.append(panels[far])
                panels = panels[~far]
                leaf = tree.is_leaf[panels.source]
                seen = replace(panels[leaf], source=tree.start[panels.source[leaf]])
                fine = (_analytic_ratios(curve, clusters, seen) >= EXACT[-1]) | (
                    seen.width <= 2.0**-48
                )  # even at contact
                single.append(seen[fine])
                left = np.ones(len(panels), dtype=bool)
                left[leaf] = ~fine
                # each with both children of the cluster it sees, or both of its halves if these are larger
                panels = panels[left]
                child = tree.child[panels.source]
                opened = (child > 0) & (clusters.radius[panels.source] >= panels.halves(curve))
                same, halved, child = panels[opened], panels[~opened], child[opened]
                first = replace(halved, width=0.5 * halved.width)
                second = replace(first, begin=first.begin + first.width)
                panels = Panels.joined([replace(same, source=child), replace(same, source=child + 1), first, second])
        one, many = Panels.joined(single), Panels.joined(clustered)
        # by their number of Gauss points: of those that see clusters by the distance from these to half length
        clear = (_distances(curve, clusters, many) - clusters.radius[many.source]) / many.halves(curve)
        return cls(
            curve, _grouped(one, _analytic_ratios(curve, clusters, one), EXACT), _grouped(many, clear, CLUSTERED), theta
        )

    def suits(self, curve: Curve, clusters: Clusters, slack: float) -> bool:
        """Whether another curve can be integrated by it, if radii and distances may be too small by that factor ≤ 1."""
        if curve.mesh != self.curve.mesh:
            return False
        if np.array_equal(curve.vertices, self.curve.vertices):
            return True
        return all(
            np.all(_analytic_ratios(curve, clusters, panels) >= slack * EXACT[points - 1])
            for points, panels in self.single
        ) and all(np.all(_are_far(curve, clusters, panels, self.theta / slack)) for _, panels in self.clustered)

    def chunks(self, clusters: Clusters) -> Iterator[tuple[Potential, Panels, int]]:
        """Potentials, the panels that see their sources, and the number of points on each."""
        for source, groups in ((clusters.simplices, self.single), (clusters, self.clustered)):
            for points, panels in groups:
                size = 8192 // points  # potentials at once, for the processor's cache
                for first in range(0, len(panels), size):
                    yield source.potential, panels[first : first + size], points


def _are_far(curve: Curve, clusters: Clusters, panels: Panels, theta: float) -> BoolArray:
    """Whether the clusters that panels see may count by their moments."""
    bound = clusters.radius[panels.source] + panels.halves(curve)
    return np.asarray(bound < theta * _distances(curve, clusters, panels))


def _analytic_ratios(curve: Curve, clusters: Clusters, panels: Panels) -> FloatArray:
    """Analytic radius to half length, for panels that see simplices."""
    tau = (curve.edge_vectors / curve.edge_lengths[:, None]).T[:, panels.edge]
    reach = clusters.simplices.reach(panels.source, panels.middles(curve), tau)
    return np.asarray(reach / panels.halves(curve))


def _distances(curve: Curve, clusters: Clusters, panels: Panels) -> FloatArray:
    return norm(panels.middles(curve) - clusters.center[:, panels.source])


def _grouped(panels: Panels, ratio: FloatArray, least: FloatArray) -> Groups:
    """The panels by the number of points that they need."""
    points = np.minimum(np.searchsorted(-least, -ratio) + 1, MAX_POINTS)
    order = np.argsort(panels.edge, kind="stable")
    points, panels = points[order], panels[order]
    return tuple((k, panels[points == k]) for k in np.unique(points).tolist())
