"""The default energy's pairs of edges: their scalars and the sums that make the derivative, as thin matrix products."""

from typing import NamedTuple

import numpy as np
from scipy.spatial.distance import cdist

from ..base.types import BoolArray, FloatArray, IntArray
from ..curve import Curve, Mesh
from .edge_pairs import half_changes

Coefficients = tuple[FloatArray, FloatArray, FloatArray, FloatArray]
"""s, a, b and c of pairs: ∂W/∂e_I = s (ℓ_J τ_I + e_J) − 2 b Δ and ∂W/∂Δ = 2 (a Δ − b e_I − c e_J)."""


class Edges(NamedTuple):
    """The edges of a curve; the derivative is linear in edges e, lengths ℓ and midpoints m."""

    e_ell: FloatArray  # e and ℓ; (edges, m + 1)
    m_one: FloatArray  # midpoints, from their mean, and ones; (edges, m + 1)
    tau: FloatArray  # unit tangents; (edges, m)
    foot: FloatArray  # (−e, ⟨m, e⟩), (edges, m + 1): times (m_J, 1) it is ⟨m_I − m_J, e_I⟩

    @classmethod
    def of(cls, curve: Curve) -> "Edges":
        # products of coordinates lose digits far from the origin, so the curve is moved to the origin
        e, ell, m = curve.edge_vectors, curve.edge_lengths, curve.midpoints - curve.midpoints.mean(axis=0)
        foot = np.column_stack([-e, np.einsum("ij,ij->i", m, e)])
        return cls(np.column_stack([e, ell]), np.column_stack([m, np.ones(len(m))]), e / ell[:, None], foot)

    @property
    def e(self) -> FloatArray:
        return self.e_ell[:, :-1]

    @property
    def ell(self) -> FloatArray:
        return self.e_ell[:, -1]

    @property
    def m(self) -> FloatArray:
        return self.m_one[:, :-1]


class Pairs(NamedTuple):
    """Scalars of the edge pairs of one tile, each of shape (rows, columns); all but g are 0 for excluded pairs."""

    g: FloatArray  # ℓ_I ℓ_J + ⟨e_I, e_J⟩
    p: FloatArray  # ⟨Δ, e_I⟩ s
    q: FloatArray  # ⟨Δ, e_J⟩ s
    s: FloatArray  # 1/|Δ|²

    @classmethod
    def of(cls, edges: Edges, rows: slice | IntArray, columns: slice, excluded: BoolArray) -> "Pairs":
        # distances are computed from differences: strands may be close
        r2 = cdist(edges.m[rows].real, edges.m[columns].real, "sqeuclidean")
        r2[excluded] = np.inf
        s = np.divide(1.0, r2, out=r2)
        if np.iscomplexobj(edges.m):
            s = s - 2j * s * s * half_changes(edges.m[rows], edges.m[columns])
        p = edges.foot[rows] @ edges.m_one[columns].T
        q = edges.m_one[rows] @ -edges.foot[columns].T
        p *= s
        q *= s
        return cls(edges.e_ell[rows] @ edges.e_ell[columns].T, p, q, s)

    def energy(self) -> float:
        """Σ W_IJ over the tile, W_IJ = g s − 2 p q."""
        return float(np.vdot(self.g, self.s) - 2.0 * np.vdot(self.p, self.q))

    def coefficients(self) -> Coefficients:
        """a = 4 p q s − g s², b = q s and c = p s, in place of the others: fresh arrays would crowd the cache."""
        g, p, q, s = self
        a = p * q
        a *= 4.0
        g *= s
        a -= g
        for each in (a, p, q):
            each *= s
        return s, a, q, p


class PartnerSums(NamedTuple):
    """Sums over the partners J of each edge I, from which the derivative is assembled in the end."""

    a: FloatArray  # Σ a (m_J, 1), shape (edges, m + 1)
    b: FloatArray  # Σ b (m_J, 1); if the edges change places Δ changes its sign, and b and c change places and signs
    c: FloatArray  # Σ c e_J, shape (edges, m)
    s: FloatArray  # Σ s (e_J, ℓ_J), shape (edges, m + 1)

    @classmethod
    def zeros(cls, edges: Edges) -> "PartnerSums":
        return cls(*map(np.zeros_like, (edges.m_one, edges.m_one, edges.e, edges.e_ell)))

    def add(self, rows: slice, columns: slice, coefficients: Coefficients, edges: Edges) -> None:
        """Add the pairs of some rows and columns, seen from I and seen from J."""
        (s, a, b, c), (e_ell, m_one), e = coefficients, edges[:2], edges.e
        self.a[rows] += a @ m_one[columns]
        self.b[rows] += b @ m_one[columns]
        self.c[rows] += c @ e[columns]
        self.s[rows] += s @ e_ell[columns]
        self.a[columns] += a.T @ m_one[rows]
        self.b[columns] -= c.T @ m_one[rows]
        self.c[columns] -= b.T @ e[rows]
        self.s[columns] += s.T @ e_ell[rows]

    def derivatives(self, edges: Edges) -> "EdgeDerivatives":
        """Σ_J a_IJ Δ = (Σ_J a_IJ) m_I − Σ_J a_IJ m_J, and so on."""
        a, b = (each[:, -1:] * edges.m - each[:, :-1] for each in (self.a, self.b))
        by_midpoint = 2.0 * (a - self.b[:, -1:] * edges.e - self.c)
        return EdgeDerivatives(self.s[:, :-1] - 2.0 * b, by_midpoint, self.s[:, -1])


class EdgeDerivatives(NamedTuple):
    """Sums over the partners of each edge: ∂E/∂e without the terms along τ, ∂E/∂m, and ∂E/∂ℓ, which is along τ."""

    by_edge: FloatArray
    by_midpoint: FloatArray
    by_length: FloatArray

    def row_energies(self, edges: Edges) -> FloatArray:
        """Σ_J W_IJ for each edge I, shape (edges,): it follows from the derivative, W_IJ being linear in (e_I, ℓ_I)."""
        return np.asarray(np.einsum("ij,ij->i", self.by_edge, edges.e) + self.by_length * edges.ell)

    def at_vertices(self, mesh: Mesh, tau: FloatArray) -> FloatArray:
        """The derivative with respect to the vertices, shape (n, m)."""
        by_edge, half = self.by_edge + self.by_length[:, None] * tau, 0.5 * self.by_midpoint
        return mesh.scatter(half - by_edge, half + by_edge)
