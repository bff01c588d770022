"""Integrals of a potential along edges, from which its energy and derivatives with respect to the vertices follow."""

from collections.abc import Iterator
from typing import NamedTuple, Protocol

import numpy as np

from ...quadrature import gauss_legendre
from ...types import FloatArray, IntArray
from .clusters import Clusters
from .panels import Edges, Panels
from .schedule import Group, Schedule
from .simplices import Potentials
from .vectors import dot

CHUNK = 8192  # points at which a potential is taken at once, for the processor's cache


class Sources(Protocol):
    """Simplices, or clusters of them."""

    def potential(self, index: IntArray, x: FloatArray) -> Potentials:
        """Φ and ∇Φ of some sources, shape (k,), each at its own points, shape (3, k, points)."""

    def change(self, index: IntArray, x: FloatArray, v: FloatArray) -> Potentials:
        """How they change as the points move with velocities v."""


class Forces(NamedTuple):
    """The derivative of an energy by the tails and heads of edges, or how it changes; shape (3, n) each."""

    at_tails: FloatArray
    at_heads: FloatArray


class Integrals(NamedTuple):
    """∫ Φ dt, shape (n,), ∫ ∇Φ dt and ∫ t ∇Φ dt, shape (3, n), over every edge, t = 0 … 1; or how these change."""

    potential: FloatArray
    gradient: FloatArray
    moment: FloatArray

    @classmethod
    def of(cls, edges: Edges, clusters: Clusters, schedule: Schedule, motion: Edges | None = None) -> "Integrals":
        """Those over edges, or their derivatives as the edges move."""
        n = edges.tail.shape[1]
        total = cls(np.zeros(n), np.zeros((3, n)), np.zeros((3, n)))
        for sources, panels, points in _chunks(clusters, schedule):
            u, weight = gauss_legendre(points)
            t = panels.begin[:, None] + panels.width[:, None] * u
            x = edges.at(panels.edge, t)
            if motion is None:
                seen = sources.potential(panels.source, x)
            else:
                seen = sources.change(panels.source, x, motion.at(panels.edge, t))
            total._add(panels.edge, t, panels.width[:, None] * weight, seen)
        return total

    def _add(self, edge: IntArray, t: FloatArray, weight: FloatArray, seen: Potentials) -> None:
        """Add the values at points t of some edges, weighted."""
        first = edge.min()  # edges of a chunk are near to each other
        place = edge - first
        here = slice(first, first + place.max() + 1)
        moments = weight * t
        self.potential[here] += np.bincount(place, np.einsum("kp,kp->k", weight, seen.value))
        for i, component in enumerate(seen.gradient):
            self.gradient[i, here] += np.bincount(place, np.einsum("kp,kp->k", weight, component))
            self.moment[i, here] += np.bincount(place, np.einsum("kp,kp->k", moments, component))

    def energy(self, edges: Edges) -> float:
        """Σ ℓ ∫ Φ dt."""
        return float(edges.length @ self.potential)

    def forces(self, edges: Edges) -> Forces:
        """The derivative of the energy: ℓ ∫ (1 − t) ∇Φ dt − τ ∫ Φ dt at tails, ℓ ∫ t ∇Φ dt + τ ∫ Φ dt at heads."""
        along = np.asarray(edges.vector / edges.length * self.potential)
        at_heads = edges.length * self.moment
        return Forces(edges.length * self.gradient - at_heads - along, at_heads + along)

    def force_changes(self, edges: Edges, motion: Edges, change: "Integrals") -> Forces:
        """The derivative of the forces as the edges move, which changes these integrals by ``change``."""
        tau = edges.vector / edges.length
        growth = dot(tau, motion.vector)
        turn = (motion.vector - growth * tau) / edges.length
        along = np.asarray(turn * self.potential + tau * change.potential)
        at_heads = growth * self.moment + edges.length * change.moment
        both = growth * self.gradient + edges.length * change.gradient
        return Forces(both - at_heads - along, at_heads + along)


def _chunks(clusters: Clusters, schedule: Schedule) -> Iterator[tuple[Sources, Panels, int]]:
    """Sources, the panels that see them, and the number of points on each."""
    kinds: tuple[tuple[Sources, tuple[Group, ...]], ...]
    kinds = (clusters.simplices, schedule.single), (clusters, schedule.clustered)
    for sources, groups in kinds:
        for points, panels in groups:
            size = CHUNK // points
            for first in range(0, len(panels), size):
                yield sources, panels[first : first + size], points
