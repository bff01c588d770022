"""The constraints Φ of Section 6.1.3 of [RS21]: prescribed edge lengths and a fixed barycenter.

Φ = (log ℓ_I − log ℓ⁰_I)_I together with Σ ℓ_I m_I minus its target.  Lengths enter as logarithms, so one
tolerance means the same relative error on every edge.  Parts of a link that are far from each other can have a fixed
barycenter each.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from .curve import Curve, Mesh
from .types import FloatArray

Parts = tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Constraints:
    """Targets of the constraints.

    Parameters
    ----------
    lengths
        Target lengths ℓ⁰, positive, shape (edges,).
    barycenter
        Target of Σ ℓ_I m_I, shape (m,); for p parts one after the other, shape (p·m,).
    parts
        For each component the number of its part, from 0; None if all are one.
    """

    lengths: FloatArray
    barycenter: FloatArray
    parts: Parts | None = None

    def of_parts(self, curve: Curve, parts: Parts) -> "Constraints":
        """The same lengths, with the barycenter of each part kept where it is in ``curve``."""
        return Constraints(self.lengths, weighted_barycenter(curve, parts), parts)

    def derivative(self, curve: Curve) -> "ConstraintDerivative":
        """DΦ at a curve."""
        return ConstraintDerivative.at(curve, self.parts)

    def residual(self, curve: Curve) -> FloatArray:
        """Φ(P): the logarithmic length errors, then the p·m barycenter errors; shape (edges + p·m,)."""
        shift = weighted_barycenter(curve, self.parts) - self.barycenter
        return np.concatenate([np.log(curve.edge_lengths / self.lengths), shift])

    def error(self, mesh: Mesh, residual: FloatArray) -> float:
        """The largest relative error of a length, or distance of a barycenter from its target, that a residual means.

        Σ ℓ_I m_I itself is so large on long chains of components that its rounding is above any tolerance.
        """
        n = mesh.edges
        totals = np.array([own @ self.lengths for own in _memberships(mesh, self.parts)])
        shifts = residual[n:].reshape(len(totals), -1) / totals[:, None]
        return max(float(np.max(np.abs(residual[:n]))), float(np.max(np.abs(shifts), initial=0.0)))

    def length_error(self, curve: Curve) -> float:
        """max |log ℓ/ℓ⁰| over the edges."""
        return float(np.max(np.abs(np.log(curve.edge_lengths / self.lengths))))


def weighted_barycenter(curve: Curve, parts: Parts | None = None) -> FloatArray:
    """Σ ℓ_I (P(I↑) + P(I↓))/2, for each of p parts; shape (p·m,)."""
    moments = np.ascontiguousarray((curve.edge_lengths[:, None] * curve.midpoints).T)  # so that sums are pairwise ones
    return np.concatenate([np.sum(moments * own, axis=1) for own in _memberships(curve.mesh, parts)])


def _memberships(mesh: Mesh, parts: Parts | None) -> Iterator[FloatArray]:
    """For each part, 1 at its edges and 0 elsewhere; shape (edges,)."""
    if parts is None:
        yield np.ones(mesh.edges)
        return
    part = np.asarray(parts)[mesh.edge_component]
    yield from (np.where(part == k, 1.0, 0.0) for k in range(max(parts) + 1))


@dataclass(frozen=True, eq=False)
class ConstraintDerivative:
    """DΦ(P) as an operator; every constraint's derivative is linear in few numbers per edge.

    Attributes
    ----------
    mesh
        Connectivity.
    tangents
        τ_I/ℓ_I, so that the length rows are ⟨τ_I/ℓ_I, ΔU_I⟩; shape (edges, m).
    masses, moments
        Of the barycenters, which also move with vertices and as edges become longer: (ℓ_I + ℓ_{I−1})/2 at each vertex,
        shape (n,), and ℓ_I m_I for each edge, shape (edges, m).
    membership
        Which vertices are in which of p parts, as 0 and 1; sparse, shape (p, n), without barycenter (0, n).
    """

    mesh: Mesh
    tangents: FloatArray
    masses: FloatArray
    moments: FloatArray
    membership: sp.csr_array

    @classmethod
    def of_lengths(cls, curve: Curve) -> "ConstraintDerivative":
        """The length rows alone."""
        return cls._of(curve, sp.csr_array((0, len(curve))))

    @classmethod
    def at(cls, curve: Curve, parts: Parts | None = None) -> "ConstraintDerivative":
        """DΦ at the curve."""
        part = np.asarray(parts or (0,) * len(curve.mesh.component_sizes))
        places = part[curve.mesh.component], np.arange(len(curve))
        return cls._of(curve, sp.csr_array((np.ones(len(curve)), places), shape=(part.max() + 1, len(curve))))

    @classmethod
    def _of(cls, curve: Curve, membership: sp.csr_array) -> "ConstraintDerivative":
        ell, mesh = curve.edge_lengths, curve.mesh
        tangents = curve.edge_vectors / ell[:, None] ** 2
        return cls(mesh, tangents, 0.5 * mesh.scatter(ell, ell), ell[:, None] * curve.midpoints, membership)

    @property
    def pinned(self) -> int:
        """Number of rows of barycenters, p·m."""
        return int(self.membership.shape[0]) * self.tangents.shape[1]

    @property
    def count(self) -> int:
        """Number of rows, edges + p·m."""
        return len(self.tangents) + self.pinned

    @property
    def shape(self) -> tuple[int, int]:
        """Shape (n, m) of displacements."""
        return self.mesh.size, self.tangents.shape[1]

    def barycenter_rows(self) -> Iterator[FloatArray]:
        """The rows of the barycenters one by one, part by part and coordinate by coordinate; shape (n, m) each."""
        for k in range(self.count - self.pinned, self.count):
            unit = np.zeros(self.count)
            unit[k] = 1.0
            yield self.apply_transpose(unit)

    def length_rows(self) -> sp.csr_array:
        """The rows of the lengths as a sparse matrix; shape (edges, n·m)."""
        edges, m = self.tangents.shape
        edge, coordinate = np.indices((edges, m))
        ends = [m * end[edge] + coordinate for end in (self.mesh.tails, self.mesh.heads)]
        entries = np.concatenate([-self.tangents.ravel(), self.tangents.ravel()])
        places = (np.concatenate([edge.ravel()] * 2), np.concatenate([end.ravel() for end in ends]))
        return sp.csr_array((entries, places), shape=(edges, self.mesh.size * m))

    def apply(self, u: FloatArray) -> FloatArray:
        """DΦ u; shape (edges + p·m,) from (n, m)."""
        along = np.einsum("ij,ij->i", self.tangents, u[self.mesh.heads] - u[self.mesh.tails])
        stretched = self.mesh.at_tails(along[:, None] * self.moments)
        moved = self.membership @ (self.masses[:, None] * u + stretched)
        return np.concatenate([along, moved.ravel()])

    def apply_transpose(self, multipliers: FloatArray) -> FloatArray:
        """DΦᵀ λ; shape (n, m) from (edges + p·m,)."""
        edges, m = self.tangents.shape
        force = self._parts_to_vertices @ multipliers[edges:].reshape(-1, m)
        tension = multipliers[:edges] + np.einsum("ij,ij->i", self.moments, force[self.mesh.tails])
        pull = tension[:, None] * self.tangents
        return np.asarray(self.mesh.scatter(-pull, pull) + self.masses[:, None] * force)

    @cached_property
    def _parts_to_vertices(self) -> sp.csr_array:
        return sp.csr_array(self.membership.T)
