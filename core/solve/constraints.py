"""The constraints Φ of Section 6.1.3 of [RS21]: prescribed edge lengths and fixed barycenters; and pins.

Φ = (log ℓ_I − log ℓ⁰_I)_I followed by Σ ℓ_I m_I of every part of the curve that no pin holds in place.  Lengths enter
as logarithms, so one tolerance means the same relative error on every edge; solvers of (41) eliminate them by their
structure, which the few rows of barycenters border.

A pinned vertex is no unknown: P_v = P⁰_v holds exactly, not as rows of Φ.  It takes the place of its part's barycenter,
and the length of an edge between two pins, which cannot change, is no row either: so DΦ has full rank on what is free.

Under a symmetry all vertices of an orbit are one unknown: images are put where they belong, as pins are.  Φ keeps its
rows, whose solutions are symmetric where the curve is.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from ..base import FloatArray, IntArray, dot
from ..curve import NO_PINS, NOWHERE, Curve, Mesh, Pins, free_edges
from ..curve.symmetry import NO_SYMMETRY, Symmetry

Parts = tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Barycenters:
    """Σ ℓ_I m_I = target, part by part; parts of a link that are far from each other have one each."""

    parts: Parts  # for each component the number of its part, from 0
    loose: Parts  # the p parts without pins, ascending
    target: FloatArray  # in the order of ``loose``, coordinate by coordinate; shape (p·m,)

    @classmethod
    def of(cls, curve: Curve, pins: Pins = NO_PINS, parts: Parts | None = None) -> "Barycenters":
        """Those of a curve; it is one part by default."""
        part = np.asarray(parts or (0,) * len(curve.mesh.component_sizes))
        loose = np.setdiff1d(part, part[curve.mesh.component[pins.vertices]])
        return cls(tuple(part.tolist()), tuple(loose.tolist()), np.empty(0)).on(curve)

    def on(self, curve: Curve) -> "Barycenters":
        """The same for a curve of another place, shape, mesh or units, with the targets that it has there."""
        moments = curve.moments
        each = [np.sum(moments * own, axis=1) for own in self._memberships(curve.mesh)]
        return replace(self, target=np.concatenate([np.empty(0), *each]))

    def error(self, lengths: FloatArray, mesh: Mesh, residual: FloatArray) -> float:
        """The largest displacement of a barycenter; of Σ ℓ_I m_I itself the rounding may exceed any tolerance."""
        totals = [own @ lengths for own in self._memberships(mesh)]
        shifts = [shift / total for shift, total in zip(self._by_part(residual), totals, strict=True)]
        return float(np.max(np.abs(shifts), initial=0.0))

    def corrected(self, curve: Curve, u: FloatArray, stretch: FloatArray, residual: FloatArray) -> FloatArray:
        """Displacements u, which change lengths by ``stretch``, with translations that reach the targets as well."""
        ell, mesh, u = curve.edge_lengths, curve.mesh, u.copy()
        # what the change of lengths does to Σ ℓ_I m_I, translations are to undo
        moments = stretch[:, None] * curve.midpoints + (0.5 * ell)[:, None] * (u[mesh.tails] + u[mesh.heads])
        part = np.asarray(self.parts)
        for k, missing in zip(self.loose, self._by_part(-residual), strict=True):
            own = part[mesh.edge_component] == k
            u[part[mesh.component] == k] += (missing - moments[own].sum(axis=0)) / ell[own].sum()
        return u

    def _memberships(self, mesh: Mesh) -> Iterator[FloatArray]:
        """For each loose part, 1 at its edges and 0 elsewhere; shape (edges,)."""
        part = np.asarray(self.parts)[mesh.edge_component]
        return (np.where(part == k, 1.0, 0.0) for k in self.loose)

    def _by_part(self, rows: FloatArray) -> FloatArray:
        return rows.reshape(len(self.loose), -1) if self.loose else np.empty((0, 0))


@dataclass(frozen=True, eq=False)
class Constraints:
    """Targets of the constraints."""

    lengths: FloatArray  # target lengths ℓ⁰, positive, shape (edges,)
    barycenters: Barycenters
    pins: Pins = NO_PINS  # vertices that stay where they are
    symmetry: Symmetry = NO_SYMMETRY  # which all displacements have
    grown: float = 1.0  # how many times as long the targets are as they were at first, but for edges between two pins

    @classmethod
    def of(cls, curve: Curve, pins: Pins = NO_PINS, barycenters: Barycenters | None = None) -> "Constraints":
        """Those that a curve satisfies, in one part, or in those of other barycenters."""
        held = Barycenters.of(curve, pins) if barycenters is None else barycenters.on(curve)
        return cls(curve.edge_lengths, held, pins)

    def scaled(self, factor: float, mesh: Mesh) -> "Constraints":
        """All lengths times a factor, but for edges between two pins; barycenters stay where they are."""
        lengths, free, held = self.lengths.copy(), free_edges(mesh, self.pins.vertices), self.barycenters
        lengths[free] *= factor
        held = replace(held, target=factor * held.target)  # Σ ℓ_I m_I is a length times a place
        return replace(self, lengths=lengths, barycenters=held, grown=factor * self.grown)

    def derivative(self, curve: Curve) -> "ConstraintDerivative":
        edges, held = free_edges(curve.mesh, self.pins.vertices), self.barycenters
        return ConstraintDerivative(curve, edges, self.pins.vertices, held.parts, held.loose, self.symmetry)

    def residual(self, curve: Curve) -> FloatArray:
        """Φ(P): the logarithmic errors of r lengths, then the k rows of barycenters; shape (r + k,)."""
        stretch = np.log(curve.edge_lengths / self.lengths)
        rows, held = free_edges(curve.mesh, self.pins.vertices), self.barycenters
        return np.concatenate([stretch[rows], held.on(curve).target - held.target])

    def error(self, mesh: Mesh, residual: FloatArray) -> float:
        """The largest relative error of a length, or what displacements compare to it, that a residual means."""
        rows = len(free_edges(mesh, self.pins.vertices))
        worst = float(np.max(np.abs(residual[:rows]), initial=0.0))
        return max(worst, self.barycenters.error(self.lengths, mesh, residual[rows:]))

    def length_error(self, curve: Curve) -> float:
        return float(np.max(np.abs(np.log(curve.edge_lengths / self.lengths))))


@dataclass(frozen=True, eq=False)
class ConstraintDerivative:
    """DΦ(P) as an operator: r rows of lengths, then m of each loose part's barycenter, k in all.

    Barycenters move with vertices, and as edges become longer.  Without parts there are lengths alone.
    """

    curve: Curve  # P
    edges: IntArray  # those whose lengths are rows, ascending; shape (r,)
    pins: IntArray  # vertices at which u is 0
    parts: Parts = ()  # as in `Barycenters`
    loose: Parts = ()
    symmetry: Symmetry = NO_SYMMETRY

    @classmethod
    def of_lengths(cls, curve: Curve, pins: IntArray = NOWHERE) -> "ConstraintDerivative":
        """The rows of all lengths alone, those between pins with them: what is a weight need not have full rank."""
        return cls(curve, np.arange(curve.mesh.edges), pins)

    @property
    def mesh(self) -> Mesh:
        return self.curve.mesh

    @property
    def shape(self) -> tuple[int, int]:
        return self.mesh.size, self.curve.dimension

    @property
    def count(self) -> int:
        return len(self.edges) + len(self.loose) * self.curve.dimension

    @cached_property
    def tangents(self) -> FloatArray:
        """τ_I/ℓ_I, so that the length rows are ⟨τ_I/ℓ_I, ΔU_I⟩; shape (edges, m)."""
        return np.asarray(self.curve.edge_vectors / self.curve.edge_lengths[:, None] ** 2)

    @cached_property
    def _masses(self) -> FloatArray:
        """(ℓ_I + ℓ_{I−1})/2 at each vertex; shape (n, 1)."""
        return 0.5 * self.mesh.scatter(self.curve.edge_lengths, self.curve.edge_lengths)[:, None]

    @cached_property
    def _moments(self) -> FloatArray:
        """ℓ_I m_I; shape (edges, m)."""
        return np.asarray(self.curve.edge_lengths[:, None] * self.curve.midpoints)

    @cached_property
    def _part(self) -> IntArray:
        """Which loose part each component is in, their number if in none; shape (components,)."""
        row = np.full(max(self.parts) + 1, len(self.loose))
        row[list(self.loose)] = np.arange(len(self.loose))
        return np.asarray(row[list(self.parts)])

    def border(self) -> Iterator[FloatArray]:
        """The rows of barycenters one by one; shape (n, m) each."""
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
        return sp.csr_array((np.ravel(entries), places), shape=(len(tangents), n * m))

    def apply(self, u: FloatArray) -> FloatArray:
        """DΦ u; shape (r + k,) from (n, m)."""
        stretch = dot(self.tangents, self.mesh.changes(u))
        if not self.loose:
            return np.asarray(stretch[self.edges])
        # what displaces the vertices of each part and stretches its edges
        stretched = self.mesh.at_tails(stretch[:, None] * self._moments)
        stretched += self._masses * u
        total = np.zeros((len(self.loose) + 1, u.shape[1]))
        np.add.at(total, self._part, np.add.reduceat(stretched, self.mesh.offsets[:-1], axis=0))
        return np.concatenate([stretch[self.edges], total[:-1].ravel()])

    def apply_transpose(self, multipliers: FloatArray) -> FloatArray:
        """DΦᵀ λ, with the forces that pins take; shape (n, m) from (r + k,)."""
        tensions, forces = self.loads(multipliers)
        pull = tensions[:, None] * self.tangents
        return np.asarray(self.mesh.scatter(-pull, pull) + forces)

    def loads(self, multipliers: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The tensions of edges, shape (edges,), and forces on vertices, shape (n, m), of all multipliers."""
        tensions, (n, m) = self.tensions(multipliers), self.shape
        if not self.loose:
            return tensions, np.zeros((n, m))
        # the multiplier of its part's barycenter pulls at each vertex and edge
        pull = np.append(multipliers[len(self.edges) :], np.zeros(m)).reshape(-1, m)[self._part]
        tensions += dot(self._moments, pull.take(self.mesh.edge_component, axis=0))
        return tensions, pull.take(self.mesh.component, axis=0) * self._masses

    def tensions(self, multipliers: FloatArray) -> FloatArray:
        """The multipliers of the lengths by edges, 0 where there is no row; shape (edges,) from (r, …)."""
        tension = np.zeros(self.mesh.edges)
        tension[self.edges] = multipliers[: len(self.edges)]
        return tension
