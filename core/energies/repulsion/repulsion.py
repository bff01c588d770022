"""The repulsion of obstacles at rest: their potential, integrated along a curve.

    R(P) = Σ_I ∫_I Φ ds,   Φ(x) = ∫_triangles dA(y)/|x − y|³ + 2 ∫_segments ds(y)/|x − y|²

is scale-invariant, as the Möbius energy is, and each exponent is the least for which every contact, even a transversal
one, has infinite energy.  Planes and straight lines alike have Φ = 2π/h at the distance h, which is the Möbius energy
per length of two parallel strands.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
import scipy.sparse as sp

from ...base.types import FloatArray
from ...curve import Curve, Obstacle
from ..edge_pairs import change, stepped
from ..quadrature import gauss_legendre
from .schedule import Schedule
from .simplices import Clusters, Simplices, norm

THETA = 0.4  # errors up to some 6·10⁻⁴ of R and 10⁻³ of its derivative
KEPT = 0.9  # slack up to which a schedule is as good as a new one
OUTDATED = 0.75  # slack up to which it is good enough for a line search


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
