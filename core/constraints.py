"""The constraints Φ of Section 6.1.3 of [RS21]: prescribed edge lengths and a fixed barycenter, or pins.

Φ = (log ℓ_I − log ℓ⁰_I)_I together with Σ ℓ_I m_I minus its target.  Lengths enter as logarithms, so one
tolerance means the same relative error on every edge.  Parts of a link that are far from each other can have a fixed
barycenter each.

A pinned vertex is no unknown: P_v = P⁰_v holds exactly, not as rows of Φ.  It takes the place of its part's barycenter,
and the length of an edge between two pins, which cannot change, is no row either: so DΦ has full rank on what is free.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from .curve import Curve, Mesh
from .curve.pins import NO_PINS, NOWHERE, Pins, free_edges
from .types import FloatArray, IntArray

Parts = tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Constraints:
    """Targets of the constraints.

    Parameters
    ----------
    lengths
        Target lengths ℓ⁰, positive, shape (edges,).
    barycenter
        Target of Σ ℓ_I m_I, shape (m,); for p parts without pins one after the other, shape (p·m,).
    parts
        For each component the number of its part, from 0; None if all are one.
    pins
        Vertices that stay where they are.
    grown
        How many times as long the targets are as they were at first, but for edges between two pins.
    """

    lengths: FloatArray
    barycenter: FloatArray
    parts: Parts | None = None
    pins: Pins = NO_PINS
    grown: float = 1.0

    def of_parts(self, curve: Curve, parts: Parts) -> "Constraints":
        """The same lengths and pins, with the barycenter of each part kept where it is in ``curve``."""
        return replace(self, barycenter=weighted_barycenter(curve, parts, self.pins.vertices), parts=parts)

    def scaled(self, factor: float, mesh: Mesh) -> "Constraints":
        """All lengths times a factor, but for edges between two pins, and the barycenters in their places."""
        lengths, free = self.lengths.copy(), free_edges(mesh, self.pins.vertices)
        lengths[free] *= factor
        return replace(self, lengths=lengths, barycenter=factor * self.barycenter, grown=factor * self.grown)

    def derivative(self, curve: Curve) -> "ConstraintDerivative":
        """DΦ at a curve."""
        return ConstraintDerivative.at(curve, self.parts, self.pins.vertices)

    def residual(self, curve: Curve) -> FloatArray:
        """Φ(P): the logarithmic errors of r lengths, then the p·m barycenter errors; shape (r + p·m,)."""
        shift = weighted_barycenter(curve, self.parts, self.pins.vertices) - self.barycenter
        stretch = np.log(curve.edge_lengths / self.lengths)
        return np.concatenate([stretch[free_edges(curve.mesh, self.pins.vertices)], shift])

    def error(self, mesh: Mesh, residual: FloatArray) -> float:
        """The largest relative error of a length, or distance of a barycenter from its target, that a residual means.

        Σ ℓ_I m_I itself is so large on long chains of components that its rounding is above any tolerance.
        """
        rows = len(free_edges(mesh, self.pins.vertices))
        worst = float(np.max(np.abs(residual[:rows]), initial=0.0))
        totals = np.array([own @ self.lengths for own in self.memberships(mesh)])
        if not len(totals):
            return worst
        shifts = residual[rows:].reshape(len(totals), -1) / totals[:, None]
        return max(worst, float(np.max(np.abs(shifts), initial=0.0)))

    def length_error(self, curve: Curve) -> float:
        """max |log ℓ/ℓ⁰| over the edges."""
        return float(np.max(np.abs(np.log(curve.edge_lengths / self.lengths))))

    def memberships(self, mesh: Mesh) -> Iterator[FloatArray]:
        """For each part with a fixed barycenter, 1 at its edges (and vertices) and 0 elsewhere; shape (n,)."""
        return _memberships(mesh, self.parts, self.pins.vertices)


def weighted_barycenter(curve: Curve, parts: Parts | None = None, pins: IntArray = NOWHERE) -> FloatArray:
    """Σ ℓ_I (P(I↑) + P(I↓))/2, for each of p parts without pins; shape (p·m,)."""
    moments = np.ascontiguousarray((curve.edge_lengths[:, None] * curve.midpoints).T)  # so that sums are pairwise ones
    each = [np.sum(moments * own, axis=1) for own in _memberships(curve.mesh, parts, pins)]
    return np.concatenate(each) if each else np.empty(0)


def _memberships(mesh: Mesh, parts: Parts | None, pins: IntArray) -> Iterator[FloatArray]:
    if parts is None and not len(pins):
        yield np.ones(mesh.edges)
        return
    part = np.asarray(parts or (0,) * len(mesh.component_sizes))
    yield from (np.where(part[mesh.edge_component] == k, 1.0, 0.0) for k in _without_pins(part[mesh.component], pins))


def _without_pins(part: IntArray, pins: IntArray) -> IntArray:
    """The parts that have no pin, from the part of each vertex."""
    return np.flatnonzero(np.bincount(part[pins], minlength=part.max() + 1) == 0)


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
    edges
        Those whose lengths are rows, ascending; shape (r,).
    pins
        Vertices at which u is 0; shape (k,).
    """

    mesh: Mesh
    tangents: FloatArray
    masses: FloatArray
    moments: FloatArray
    membership: sp.csr_array
    edges: IntArray
    pins: IntArray

    @classmethod
    def of_lengths(cls, curve: Curve, pins: IntArray = NOWHERE) -> "ConstraintDerivative":
        """The rows of all lengths alone, those between pins with them: what is a weight need not have full rank."""
        return cls._of(curve, sp.csr_array((0, len(curve))), np.arange(len(curve.mesh.tails)), pins)

    @classmethod
    def at(cls, curve: Curve, parts: Parts | None = None, pins: IntArray = NOWHERE) -> "ConstraintDerivative":
        """DΦ at the curve."""
        part = np.asarray(parts or (0,) * len(curve.mesh.component_sizes))[curve.mesh.component]
        own = sp.csr_array((np.ones(len(curve)), (part, np.arange(len(curve)))), shape=(part.max() + 1, len(curve)))
        held = own[_without_pins(part, pins)] if len(pins) else own
        return cls._of(curve, held, free_edges(curve.mesh, pins), pins)

    @classmethod
    def _of(cls, curve: Curve, membership: sp.csr_array, edges: IntArray, pins: IntArray) -> "ConstraintDerivative":
        ell, mesh = curve.edge_lengths, curve.mesh
        tangents, moments = curve.edge_vectors / ell[:, None] ** 2, ell[:, None] * curve.midpoints
        return cls(mesh, tangents, 0.5 * mesh.scatter(ell, ell), moments, membership, edges, pins)

    @property
    def shape(self) -> tuple[int, int]:
        """(n, m), the shape of u."""
        return len(self.masses), self.tangents.shape[1]

    @property
    def count(self) -> int:
        """Number of rows, r + p·m."""
        return len(self.edges) + int(self.membership.shape[0]) * self.shape[1]

    def barycenter_rows(self) -> Iterator[FloatArray]:
        """The rows of the barycenters one by one, part by part and coordinate by coordinate; shape (n, m) each."""
        for k in range(len(self.edges), self.count):
            unit = np.zeros(self.count)
            unit[k] = 1.0
            yield self.apply_transpose(unit)

    def length_rows(self) -> sp.csr_array:
        """The rows of the lengths as a sparse matrix, 0 at pins; shape (r, n·m)."""
        tangents, (n, m) = self.tangents[self.edges], self.shape
        row, coordinate = np.indices(tangents.shape)
        free = np.where(np.isin(np.arange(n), self.pins), 0.0, 1.0)
        ends = [end[self.edges] for end in (self.mesh.tails, self.mesh.heads)]
        entries = [sign * free[end][:, None] * tangents for sign, end in zip((-1.0, 1.0), ends, strict=True)]
        columns = [m * end[row] + coordinate for end in ends]
        places = (np.concatenate([row.ravel()] * 2), np.concatenate([column.ravel() for column in columns]))
        return sp.csr_array((np.concatenate([entry.ravel() for entry in entries]), places), shape=(len(row), n * m))

    def apply(self, u: FloatArray) -> FloatArray:
        """DΦ u; shape (r + p·m,) from (n, m)."""
        along = np.einsum("ij,ij->i", self.tangents, u[self.mesh.heads] - u[self.mesh.tails])
        stretched = self.mesh.at_tails(along[:, None] * self.moments)
        moved = self.membership @ (self.masses[:, None] * u + stretched)
        return np.concatenate([along[self.edges], moved.ravel()])

    def apply_transpose(self, multipliers: FloatArray) -> FloatArray:
        """DΦᵀ λ, with the forces that pins take; shape (n, m) from (r + p·m,)."""
        force = self.forces(multipliers)
        tension = self.tensions(multipliers) + np.einsum("ij,ij->i", self.moments, force[self.mesh.tails])
        pull = tension[:, None] * self.tangents
        return np.asarray(self.mesh.scatter(-pull, pull) + self.masses[:, None] * force)

    def tensions(self, multipliers: FloatArray) -> FloatArray:
        """The multipliers of the lengths by edges, 0 where there is no row; shape (edges,) from (r, …)."""
        tension = np.zeros(len(self.tangents))
        tension[self.edges] = multipliers[: len(self.edges)]
        return tension

    def forces(self, multipliers: FloatArray) -> FloatArray:
        """The multiplier of its part's barycenter for each vertex and edge, 0 without; shape (n, m)."""
        return np.asarray(self._parts_to_vertices @ multipliers[len(self.edges) :].reshape(-1, self.shape[1]))

    @cached_property
    def _parts_to_vertices(self) -> sp.csr_array:
        return sp.csr_array(self.membership.T)
