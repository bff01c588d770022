"""The constraints Φ of Section 6.1.3 of [RS21]: prescribed edge lengths and a fixed barycenter.

Φ = (log ℓ_I − log ℓ⁰_I)_I together with Σ ℓ_I m_I minus its target.  Lengths enter as logarithms, so one
tolerance means the same relative error on every edge.  Parts of a link that are far from each other can have a fixed
barycenter each.
"""

from collections.abc import Iterator
from dataclasses import dataclass

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
        Target lengths ℓ⁰, positive, shape (n,).
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
        """Φ(P): n logarithmic length errors, then the p·m barycenter errors; shape (n + p·m,)."""
        shift = weighted_barycenter(curve, self.parts) - self.barycenter
        return np.concatenate([np.log(curve.edge_lengths / self.lengths), shift])

    def error(self, mesh: Mesh, residual: FloatArray) -> float:
        """The largest relative error of a length, or distance of a barycenter from its target, that a residual means.

        Σ ℓ_I m_I itself is so large on long chains of components that its rounding is above any tolerance.
        """
        n = mesh.size
        totals = np.array([own @ self.lengths for own in _memberships(mesh, self.parts)])
        shifts = residual[n:].reshape(len(totals), -1) / totals[:, None]
        return max(float(np.max(np.abs(residual[:n]))), float(np.max(np.abs(shifts), initial=0.0)))

    def length_error(self, curve: Curve) -> float:
        """max |log ℓ/ℓ⁰| over the edges."""
        return float(np.max(np.abs(np.log(curve.edge_lengths / self.lengths))))


def weighted_barycenter(curve: Curve, parts: Parts | None = None) -> FloatArray:
    """Σ ℓ_I (P(I↑) + P(I↓))/2, for each of p parts; shape (p·m,)."""
    return np.concatenate([(curve.edge_lengths * own) @ curve.midpoints for own in _memberships(curve.mesh, parts)])


def _memberships(mesh: Mesh, parts: Parts | None) -> Iterator[FloatArray]:
    """For each part, 1 at its edges (and vertices) and 0 elsewhere; shape (n,)."""
    if parts is None:
        yield np.ones(mesh.size)
        return
    part = np.asarray(parts)[mesh.component]
    yield from (np.where(part == k, 1.0, 0.0) for k in range(max(parts) + 1))


@dataclass(frozen=True, eq=False)
class ConstraintDerivative:
    """DΦ(P) as an operator; every constraint's derivative is linear in few numbers per edge.

    Attributes
    ----------
    mesh
        Connectivity.
    tangents
        τ_I/ℓ_I, so that the length rows are ⟨τ_I/ℓ_I, ΔU_I⟩; shape (n, m).
    barycenter
        Rows of the barycenters, entry (k, v, l) the derivative of coordinate k by coordinate l of vertex v;
        shape (p·m, n, m) for p parts, or (0, n, m) without barycenter.
    """

    mesh: Mesh
    tangents: FloatArray
    barycenter: FloatArray

    @classmethod
    def of_lengths(cls, curve: Curve) -> "ConstraintDerivative":
        """The length rows alone."""
        tangents = curve.edge_vectors / curve.edge_lengths[:, None] ** 2
        return cls(curve.mesh, tangents, np.zeros((0, *curve.vertices.shape)))

    @classmethod
    def at(cls, curve: Curve, parts: Parts | None = None) -> "ConstraintDerivative":
        """DΦ at the curve."""
        ell, mesh = curve.edge_lengths, curve.mesh
        tau = curve.edge_vectors / ell[:, None]
        mass = 0.5 * mesh.scatter(ell, ell)
        rows = []
        for own in _memberships(mesh, parts):
            for k in range(curve.dimension):
                stretch = np.asarray((own * curve.midpoints[:, k])[:, None] * tau, dtype=np.float64)
                row = mesh.scatter(-stretch, stretch)
                row[:, k] += own * mass
                rows.append(row)
        return cls(mesh, tau / ell[:, None], np.stack(rows))

    @property
    def count(self) -> int:
        """Number of rows, n + p·m."""
        return len(self.tangents) + len(self.barycenter)

    def length_rows(self) -> sp.csr_array:
        """The rows of the lengths as a sparse matrix; shape (n, n·m)."""
        n, m = self.tangents.shape
        edge, coordinate = np.indices((n, m))
        ends = [m * end[edge] + coordinate for end in (self.mesh.tails, self.mesh.heads)]
        entries = np.concatenate([-self.tangents.ravel(), self.tangents.ravel()])
        places = (np.concatenate([edge.ravel()] * 2), np.concatenate([end.ravel() for end in ends]))
        return sp.csr_array((entries, places), shape=(n, n * m))

    def apply(self, u: FloatArray) -> FloatArray:
        """DΦ u; shape (n + p·m,) from (n, m)."""
        along = np.einsum("ij,ij->i", self.tangents, u[self.mesh.heads] - u[self.mesh.tails])
        return np.concatenate([along, np.einsum("kvl,vl->k", self.barycenter, u)])

    def apply_transpose(self, multipliers: FloatArray) -> FloatArray:
        """DΦᵀ λ; shape (n, m) from (n + p·m,)."""
        n = self.mesh.size
        pull = multipliers[:n, None] * self.tangents
        pinned: FloatArray = np.einsum("kvl,k->vl", self.barycenter, multipliers[n:])
        return self.mesh.scatter(-pull, pull) + pinned
