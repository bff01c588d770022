"""Fixed barycenters: Σ ℓ_I m_I of every part of a curve that no pin holds in place."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from ...base.types import FloatArray, IntArray
from ...curve import NO_PINS, Curve, Mesh, Pins

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

    @property
    def rows(self) -> int:
        return len(self.target)

    def on(self, curve: Curve) -> "Barycenters":
        moments = curve.moments
        each = [np.sum(moments * own, axis=1) for own in self.memberships(curve.mesh)]
        return replace(self, target=np.concatenate([np.empty(0), *each]))

    def scaled(self, factor: float) -> "Barycenters":
        """Barycenters stay where they are: Σ ℓ_I m_I is a length times a place, and lengths grow."""
        return replace(self, target=factor * self.target)

    def residual(self, curve: Curve) -> FloatArray:
        return self.on(curve).target - self.target

    def error(self, lengths: FloatArray, mesh: Mesh, residual: FloatArray) -> float:
        """The largest displacement of a barycenter; of Σ ℓ_I m_I itself the rounding may exceed any tolerance."""
        totals = [own @ lengths for own in self.memberships(mesh)]
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

    def derivative(self, curve: Curve) -> "BarycenterDerivative":
        ell, mesh = curve.edge_lengths, curve.mesh
        row = np.full(max(self.parts) + 1, len(self.loose))
        row[list(self.loose)] = np.arange(len(self.loose))
        masses, moments = 0.5 * mesh.scatter(ell, ell), ell[:, None] * curve.midpoints
        return BarycenterDerivative(mesh, masses, moments, row[list(self.parts)], len(self.loose))

    def memberships(self, mesh: Mesh) -> Iterator[FloatArray]:
        """For each loose part, 1 at its edges and 0 elsewhere; shape (edges,)."""
        part = np.asarray(self.parts)[mesh.edge_component]
        return (np.where(part == k, 1.0, 0.0) for k in self.loose)

    def _by_part(self, rows: FloatArray) -> FloatArray:
        return rows.reshape(len(self.loose), -1) if self.loose else np.empty((0, 0))


@dataclass(frozen=True, eq=False)
class BarycenterDerivative:
    """Barycenters move with vertices, and as edges become longer."""

    mesh: Mesh
    masses: FloatArray  # (ℓ_I + ℓ_{I−1})/2 at each vertex; shape (n,)
    moments: FloatArray  # ℓ_I m_I; shape (edges, m)
    part: IntArray  # which of p parts each component is in, p if in none; shape (components,)
    parts: int  # p

    @property
    def rows(self) -> int:
        return self.parts * int(self.moments.shape[1])

    def apply(self, u: FloatArray, stretch: FloatArray) -> FloatArray:
        """Σ over each part of what displaces its vertices and stretches its edges."""
        stretched = self.mesh.at_tails(stretch[:, None] * self.moments)
        stretched += self.masses[:, None] * u
        total = np.zeros((self.parts + 1, u.shape[1]))
        np.add.at(total, self.part, np.add.reduceat(stretched, self.mesh.offsets[:-1], axis=0))
        return total[: self.parts].ravel()

    def loads(self, multipliers: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The multiplier of its part's barycenter pulls at each vertex and edge."""
        pull = np.append(multipliers, np.zeros(self.moments.shape[1])).reshape(self.parts + 1, -1)[self.part]
        at_edges = pull.take(self.mesh.edge_component, axis=0)
        at_vertices = pull.take(self.mesh.component, axis=0)
        at_vertices *= self.masses[:, None]
        return np.einsum("ij,ij->i", self.moments, at_edges), at_vertices

    def curvature(self, multipliers: FloatArray, v: FloatArray) -> FloatArray:
        return np.zeros_like(v)
