"""The repulsion of obstacles at rest: their potential, integrated along a curve.

    R(P) = Σ_I ∫_I Φ ds,   Φ(x) = ∫_triangles dA(y)/|x − y|³ + 2 ∫_segments ds(y)/|x − y|²

is scale-invariant, as the Möbius energy is, and each exponent is the least for which every contact, even a transversal
one, has infinite energy.  Planes and straight lines alike have Φ = 2π/h at the distance h, which is the Möbius energy
per length of two parallel strands.

Quadrature along edges is graded: panels, dyadic parts of edges, are halved until the potential is analytic so far
around them that few Gauss points are enough.  This follows all singularities wherever they are; the number of panels
grows only like the logarithm of their distance.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
import scipy.sparse as sp

from ...base import BoolArray, FloatArray, IntArray
from ...curve import Curve, Obstacle
from ..edge_pairs import change, stepped
from ..quadrature import gauss_legendre
from .simplices import Clusters, Simplices, norm

Potential = Callable[[IntArray, FloatArray], tuple[FloatArray, FloatArray]]
"""Φ and ∇Φ of some simplices or clusters, shape (k,), each at its own points, shape (3, k, points)."""

MAX_POINTS = 8
# Ratios of analytic radius to half length from which 1, 2, … Gauss points leave an error of exp(−20) = 2e-9 for single
# simplices, and of exp(−8) = 3e-4 for clusters, still less than what moments leave: k points have the error ρ⁻²ᵏ, and
# the Bernstein ellipse lies within a disc of R half lengths if ρ + 1/ρ ≤ 2R.
EXACT, CLUSTERED = (np.cosh(exponent / (2.0 * np.arange(1, MAX_POINTS + 1))) for exponent in (20.0, 8.0))
THETA = 0.4  # errors up to some 6·10⁻⁴ of R and 10⁻³ of its derivative
KEPT = 0.9  # slack up to which a schedule is as good as a new one
OUTDATED = 0.75  # slack up to which it is good enough for a line search


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
                # pieces so narrow are not halved any more, even at contact
                fine = (_analytic_ratios(curve, clusters, seen) >= EXACT[-1]) | (seen.width <= 2.0**-48)
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


@dataclass(frozen=True, eq=False)
class Repulsion:
    """R of simplices of one dimension, triangles or segments.

    Every curve has its own schedule, and where that changes the value jumps by its error.  `frozen_at` keeps one,
    which gives a smooth function as long as it suits, as a line search needs.
    """

    clusters: Clusters  # the simplices, in the units of curves
    theta: float = THETA  # separation parameter of clusters; with 0 all simplices count one by one
    schedule: Schedule | None = None  # used as long as it suits; None for a schedule of each curve's own

    name = "repulsion"
    scale_exponent = 0.0

    @classmethod
    def of(cls, obstacles: Iterable[Obstacle]) -> "tuple[Repulsion, ...]":
        """One for all triangles and one for all segments, in the units of curves; those of no size repel nothing."""
        kinds = zip(*((obstacle.triangles, obstacle.segments) for obstacle in obstacles), strict=True)
        corners = (np.concatenate(kind).transpose(1, 2, 0) for kind in kinds)
        solid = (each[:, :, Simplices(each).sizes > 0.0] for each in corners)
        return tuple(cls(Clusters.of(each)) for each in solid if each.size)

    def frozen_at(self, curve: Curve) -> "Repulsion":
        """The smooth function given by the schedule of ``curve``, or by this repulsion's own if it suits."""
        schedule = self._schedule(curve, KEPT)
        return self if schedule is self.schedule else replace(self, schedule=schedule)

    def value(self, curve: Curve) -> float:
        return self.value_and_derivative(curve)[0]

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        tails, heads = _ends(curve, curve.vertices)
        value, derivative = self._at_ends(self._schedule(curve), tails, heads)
        return float(value), curve.mesh.scatter(*derivative.transpose(0, 2, 1))

    def hessian_product(self, curve: Curve, v: FloatArray) -> FloatArray:
        return curve.mesh.scatter(*self._change(curve, *_ends(curve, v)).transpose(0, 2, 1))

    def sparse_hessian(self, curve: Curve) -> sp.csr_array:
        """D²R as a sparse matrix, which couples the ends of edges only, in the order of ``vertices.ravel()``."""
        n, edges = len(curve), curve.mesh.edges
        motions = np.eye(6).reshape(6, 2, 3, 1) * np.ones(edges)
        changes = np.array([self._change(curve, tails, heads) for tails, heads in motions])
        ends = np.stack([curve.mesh.tails, curve.mesh.heads])
        index = (3 * ends[:, None] + np.arange(3)[:, None]).reshape(6, edges)
        rows, columns = np.broadcast_arrays(index[None], index[:, None])
        return sp.csr_array((changes.ravel(), (rows.ravel(), columns.ravel())), shape=(3 * n, 3 * n))

    def stiffness(self, curve: Curve) -> sp.dia_array:
        """∫ Φ³/(2π²) ds, half at either end, diagonal (n, n): a plane or line has Φ'' = 4π/h³ = Φ³/(2π²)."""
        half = 0.25 / np.pi**2 * curve.edge_lengths * self._means(curve) ** 3
        return sp.diags_array(curve.mesh.scatter(half, half))

    def clearance(self, curve: Curve) -> FloatArray:
        """2π over the mean of Φ on every edge: its distance from a plane or a straight line; shape (edges,)."""
        return np.asarray(2.0 * np.pi / self._means(curve))

    def _means(self, curve: Curve) -> FloatArray:
        """The mean values of Φ on every edge, shape (edges,)."""
        return np.asarray(self._integrals(self._schedule(curve), *_ends(curve, curve.vertices))[0])

    def _schedule(self, curve: Curve, slack: float = OUTDATED) -> Schedule:
        """The schedule in use at a curve: this repulsion's own, or the curve's."""
        if self.schedule is not None and self.schedule.suits(curve, self.clusters, slack):
            return self.schedule
        return _schedule(curve, self.clusters, self.theta)

    def _change(self, curve: Curve, tails: FloatArray, heads: FloatArray) -> FloatArray:
        """How the derivative by the ends of edges changes as these move, by a complex step; shape (2, 3, edges)."""
        moved = map(stepped, _ends(curve, curve.vertices), (tails, heads))
        return change(self._at_ends(self._schedule(curve), *moved)[1])

    def _at_ends(self, schedule: Schedule, tails: FloatArray, heads: FloatArray) -> tuple[FloatArray, FloatArray]:
        """R and its derivative by the tails and heads of edges, shape (2, 3, edges).

        With ℓ, τ and the integrals over t = 0 … 1 it is ℓ ∫ (1 − t) ∇Φ dt − τ ∫ Φ dt at tails, ℓ ∫ t ∇Φ dt + τ ∫ Φ dt
        at heads.
        """
        potential, *both = self._integrals(schedule, tails, heads)
        gradient, moment = np.reshape(both, (2, *tails.shape))
        length = norm(heads - tails)
        along, at_heads = (heads - tails) / length * potential, length * moment
        return length @ potential, np.stack([length * gradient - at_heads - along, at_heads + along])

    def _integrals(self, schedule: Schedule, tails: FloatArray, heads: FloatArray) -> FloatArray:
        """∫ Φ dt, ∫ ∇Φ dt and ∫ t ∇Φ dt over every edge; shape (7, edges) from tails and heads of shape (3, edges)."""
        total = np.zeros((7, tails.shape[1]), dtype=tails.dtype)
        for potential, panels, points in schedule.chunks(self.clusters):
            u, weight = gauss_legendre(points)
            t = panels.begin[:, None] + panels.width[:, None] * u
            tail, head = tails[:, panels.edge, None], heads[:, panels.edge, None]
            value, gradient = potential(panels.source, tail + t * (head - tail))
            integrals = panels.width * (np.concatenate([value[None], gradient, t * gradient]) @ weight)
            first = np.flatnonzero(np.diff(panels.edge, prepend=-1))
            total[:, panels.edge[first]] += np.add.reduceat(integrals, first, axis=1)
        return total


@lru_cache(maxsize=2)
def _schedule(curve: Curve, clusters: Clusters, theta: float) -> Schedule:
    """The schedule of a curve; the last ones are kept, for value, derivative and second derivative alike."""
    return Schedule.of(curve, clusters, theta)


def _ends(curve: Curve, at_vertices: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The values at the tails and heads of edges; shape (3, edges) each."""
    columns = at_vertices.T
    return columns[:, curve.mesh.tails], columns[:, curve.mesh.heads]
