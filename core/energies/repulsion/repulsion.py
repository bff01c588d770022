"""The repulsion of still obstacles: their potential, integrated along a curve.

    R(P) = Σ_I ∫_I Φ ds,   Φ(x) = ∫_triangles dA(y)/|x − y|³ + 2 ∫_segments ds(y)/|x − y|²

is scale-invariant, as the Möbius energy is, and each exponent is the least with which every contact, a transversal one
too, has infinite energy.  Planes and straight lines alike have Φ = 2π/h at the distance h, which is the Möbius energy
per length of two parallel strands.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
import scipy.sparse as sp

from ...curve import Curve, Mesh
from ...obstacle import Obstacle
from ...types import FloatArray
from .clusters import Clusters
from .integrals import Forces, Integrals
from .panels import Edges
from .schedule import Schedule
from .simplices import Simplices

THETA = 0.4  # errors up to some 6·10⁻⁴ of R and 10⁻³ of its derivative
KEPT = 0.9  # slack up to which a schedule is as good as a new one
OUTDATED = 0.75  # slack up to which it is good enough for a line search


@dataclass(frozen=True, eq=False)
class Repulsion:
    """R of simplices of one dimension, triangles or segments.

    Every curve has a schedule of its own, at whose change the value jumps by its error.  `frozen_at` keeps one, which
    makes a smooth function as long as it suits: what a line search should see.

    Parameters
    ----------
    clusters
        The simplices, in the units of curves.
    theta
        Separation parameter of clusters; with 0 all simplices count one by one.
    schedule
        The one to be used as long as it suits; None for that of each curve.
    """

    clusters: Clusters
    theta: float = THETA
    schedule: Schedule | None = None

    name = "repulsion"
    scale_exponent = 0.0
    description = "potential of still obstacles, integrated along the curve"

    @classmethod
    def of(cls, obstacles: Iterable[Obstacle]) -> "tuple[Repulsion, ...]":
        """That of obstacles, in the units of curves: one for all triangles, one for all segments, if there are any.

        Those without area or length repel nothing, and clusters of them alone would have no centroid.
        """
        kinds = zip(*((obstacle.triangles, obstacle.segments) for obstacle in obstacles), strict=True)
        corners = (np.concatenate(kind).transpose(1, 2, 0) for kind in kinds)
        solid = (each[:, :, Simplices(each).sizes > 0.0] for each in corners)
        return tuple(cls(Clusters.of(each)) for each in solid if each.size)

    def frozen_at(self, curve: Curve) -> "Repulsion":
        """The smooth function that the schedule of ``curve`` makes of it, or that its own does if it suits."""
        if self.schedule is not None and self.schedule.suits(curve, self.clusters, KEPT):
            return self
        return replace(self, schedule=_schedule(curve, self.clusters, self.theta))

    def value(self, curve: Curve) -> float:
        """R of the curve."""
        return self.value_and_derivative(curve)[0]

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        """R and its derivative with respect to the vertices, shape (n, 3)."""
        edges = Edges.of(curve.mesh, curve.vertices)
        integrals = Integrals.of(edges, self.clusters, self._schedule(curve))
        derivative = _at_vertices(curve.mesh, integrals.forces(edges))
        return integrals.energy(edges), derivative

    def hessian_product(self, curve: Curve, v: FloatArray) -> FloatArray:
        """D²R v for ``v`` of shape (n, 3); shape (n, 3)."""
        changes = self._force_changes(curve, [Edges.of(curve.mesh, v)])
        return _at_vertices(curve.mesh, changes[0])

    def sparse_hessian(self, curve: Curve) -> sp.csr_array:
        """D²R as a sparse matrix, which couples the ends of edges only, in the order of ``vertices.ravel()``."""
        n, edges = len(curve), curve.mesh.edges
        rest, unit = np.zeros((3, edges)), np.eye(3)[:, :, None] * np.ones(edges)
        tails_move, heads_move = [Edges(e, -e) for e in unit], [Edges(rest, e) for e in unit]
        changes = np.array(self._force_changes(curve, [*tails_move, *heads_move]))
        ends = np.stack([curve.mesh.tails, curve.mesh.heads])
        index = (3 * ends[:, None] + np.arange(3)[:, None]).reshape(6, edges)
        rows, columns = np.broadcast_arrays(index[None], index[:, None])
        return sp.csr_array((changes.ravel(), (rows.ravel(), columns.ravel())), shape=(3 * n, 3 * n))

    def stiffness(self, curve: Curve) -> sp.dia_array:
        """∫ Φ³/(2π²) ds, half of each edge's at either end; diagonal, shape (n, n).

        A plane at the distance h, and so a straight line, has Φ'' = 4π/h³ = Φ³/(2π²).
        """
        half = 0.25 / np.pi**2 * curve.edge_lengths * self._means(curve) ** 3
        return sp.diags_array(curve.mesh.scatter(half, half))

    def clearance(self, curve: Curve) -> FloatArray:
        """2π over the mean of Φ on every edge: its distance from a plane or a straight line; shape (edges,)."""
        return np.asarray(2.0 * np.pi / self._means(curve))

    def _means(self, curve: Curve) -> FloatArray:
        """Those of Φ on every edge, shape (edges,)."""
        edges = Edges.of(curve.mesh, curve.vertices)
        return Integrals.of(edges, self.clusters, self._schedule(curve)).potential

    def _schedule(self, curve: Curve) -> Schedule:
        """The schedule that counts at a curve: its own, or that of the curve."""
        if self.schedule is not None and self.schedule.suits(curve, self.clusters, OUTDATED):
            return self.schedule
        return _schedule(curve, self.clusters, self.theta)

    def _force_changes(self, curve: Curve, motions: list[Edges]) -> list[Forces]:
        """How the derivative by the ends of edges changes along some motions."""
        schedule, edges = self._schedule(curve), Edges.of(curve.mesh, curve.vertices)
        integrals = Integrals.of(edges, self.clusters, schedule)
        changes = (Integrals.of(edges, self.clusters, schedule, motion) for motion in motions)
        return [integrals.force_changes(edges, motion, each) for motion, each in zip(motions, changes, strict=True)]


@lru_cache(maxsize=2)
def _schedule(curve: Curve, clusters: Clusters, theta: float) -> Schedule:
    """That of a curve; the last ones are kept, for value, derivative and second derivative alike."""
    return Schedule.of(curve, clusters, theta)


def _at_vertices(mesh: Mesh, forces: Forces) -> FloatArray:
    return mesh.scatter(forces.at_tails.T, forces.at_heads.T)
