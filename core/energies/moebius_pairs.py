"""The default energy's pairs of edges: their scalars and the sums that make the derivative, as thin matrix products."""

from typing import NamedTuple

import numpy as np
from scipy.spatial.distance import cdist

from ..base.types import FloatArray
from ..curve import Curve, Mesh
from .edge_pairs import RowTile, Tile, half_changes


class Vectors(NamedTuple):
    """The vectors in which the derivative is linear: edges e with lengths ℓ, midpoints m from their mean with ones."""

    e_ell: FloatArray  # (edges, m + 1), like the other
    m_one: FloatArray

    @property
    def e(self) -> FloatArray:
        return self.e_ell[:, :-1]

    @property
    def m(self) -> FloatArray:
        return self.m_one[:, :-1]

    @property
    def ell(self) -> FloatArray:
        return self.e_ell[:, -1]


class Edges(NamedTuple):
    """The edges of a curve."""

    vectors: Vectors
    tau: FloatArray  # unit tangents, (edges, m)
    foot: FloatArray  # (−e, ⟨m, e⟩), (edges, m + 1): times (m_J, 1) it is ⟨m_I − m_J, e_I⟩

    @classmethod
    def of(cls, curve: Curve) -> "Edges":
        e, ell, m = curve.edge_vectors, curve.edge_lengths, curve.midpoints
        # products of coordinates lose digits far from the origin, so the curve is moved to the origin
        vectors = Vectors(np.column_stack([e, ell]), np.column_stack([m - m.mean(axis=0), np.ones(len(m))]))
        foot = np.column_stack([-e, np.einsum("ij,ij->i", vectors.m, e)])
        return cls(vectors, e / ell[:, None], foot)


class Pairs(NamedTuple):
    """Scalars of the edge pairs of one tile, each of shape (rows, columns); all but g are 0 for excluded pairs."""

    g: FloatArray  # ℓ_I ℓ_J + ⟨e_I, e_J⟩
    p: FloatArray  # ⟨Δ, e_I⟩ s
    q: FloatArray  # ⟨Δ, e_J⟩ s
    s: FloatArray  # 1/|Δ|²

    @classmethod
    def of(cls, edges: Edges, tile: Tile | RowTile) -> "Pairs":
        (e_ell, m_one), foot = edges.vectors, edges.foot
        rows, columns = tile.rows, tile.columns
        # distances are computed from differences: strands may be close
        r2 = cdist(edges.vectors.m[rows].real, edges.vectors.m[columns].real, "sqeuclidean")
        r2[tile.excluded] = np.inf
        s = np.divide(1.0, r2, out=r2)
        if np.iscomplexobj(m_one):
            s = s - 2j * s * s * half_changes(edges.vectors.m[rows], edges.vectors.m[columns])
        p = foot[rows] @ m_one[columns].T
        q = m_one[rows] @ -foot[columns].T
        p *= s
        q *= s
        return cls(e_ell[rows] @ e_ell[columns].T, p, q, s)

    def energy(self) -> float:
        """Σ W_IJ over the tile, W_IJ = g s − 2 p q."""
        return float(np.vdot(self.g, self.s) - 2.0 * np.vdot(self.p, self.q))

    def row_energies(self) -> FloatArray:
        """Σ_J W_IJ for each row I; shape (rows,)."""
        return np.asarray(np.einsum("ij,ij->i", self.g, self.s) - 2.0 * np.einsum("ij,ij->i", self.p, self.q))

    def coefficients(self) -> "Coefficients":
        """The derivative's coefficients, in place of all but s: fresh arrays would drive others out of the cache."""
        g, p, q, s = self
        a = p * q
        a *= 4.0
        g *= s
        a -= g
        for each in (a, p, q):
            each *= s
        return Coefficients(s, a, q, p)


class Coefficients(NamedTuple):
    """Coefficients of a tile's derivative, each of shape (rows, columns).

    ∂W/∂e_I = s (ℓ_J τ_I + e_J) − 2 b Δ,   ∂W/∂Δ = 2 (a Δ − b e_I − c e_J).
    """

    s: FloatArray
    a: FloatArray  # 4 p q s − g s²
    b: FloatArray  # q s
    c: FloatArray  # p s


class PartnerSums(NamedTuple):
    """Sums over the partners J of each edge I, from which the derivative is assembled in the end."""

    a: FloatArray  # Σ a (m_J, 1), shape (edges, m + 1)
    b: FloatArray  # Σ b (m_J, 1); if the edges change places Δ changes its sign, and b and c change places and signs
    c: FloatArray  # Σ c e_J, shape (edges, m)
    s: FloatArray  # Σ s (e_J, ℓ_J), shape (edges, m + 1)

    @classmethod
    def zeros(cls, vectors: Vectors) -> "PartnerSums":
        return cls(*map(np.zeros_like, (vectors.m_one, vectors.m_one, vectors.e, vectors.e_ell)))

    def add(self, rows: slice, columns: slice, coefficients: Coefficients, vectors: Vectors) -> None:
        """Add the pairs of some rows and columns, seen from I and seen from J."""
        (s, a, b, c), (e_ell, m_one), e = coefficients, vectors, vectors.e
        self.a[rows] += a @ m_one[columns]
        self.b[rows] += b @ m_one[columns]
        self.c[rows] += c @ e[columns]
        self.s[rows] += s @ e_ell[columns]
        self.a[columns] += a.T @ m_one[rows]
        self.b[columns] -= c.T @ m_one[rows]
        self.c[columns] -= b.T @ e[rows]
        self.s[columns] += s.T @ e_ell[rows]

    def derivatives(self, vectors: Vectors) -> "DerivativeSums":
        """Σ_J a_IJ Δ = (Σ_J a_IJ) m_I − Σ_J a_IJ m_J, and so on."""
        e, m = vectors.e, vectors.m
        a, b = (each[:, -1:] * m - each[:, :-1] for each in (self.a, self.b))
        return DerivativeSums(self.s[:, :-1] - 2.0 * b, 2.0 * (a - self.b[:, -1:] * e - self.c), self.s[:, -1])


class DerivativeSums(NamedTuple):
    """Sums over the partners of each edge: ∂E/∂e without the terms along τ, ∂E/∂m, and ∂E/∂ℓ, which is along τ."""

    by_edge: FloatArray
    by_midpoint: FloatArray
    by_length: FloatArray

    @classmethod
    def zeros(cls, shape: tuple[int, ...]) -> "DerivativeSums":
        return cls(np.zeros(shape), np.zeros(shape), np.zeros(shape[0]))

    def row_energies(self, vectors: Vectors) -> FloatArray:
        """Σ_J W_IJ for each edge I, shape (edges,): it follows from the derivative, W_IJ being linear in (e_I, ℓ_I)."""
        return np.asarray(np.einsum("ij,ij->i", self.by_edge, vectors.e) + self.by_length * vectors.ell)

    def at_vertices(self, mesh: Mesh, tau: FloatArray) -> FloatArray:
        """The derivative with respect to the vertices, shape (n, m)."""
        by_edge, half = self.by_edge + self.by_length[:, None] * tau, 0.5 * self.by_midpoint
        return mesh.scatter(half - by_edge, half + by_edge)
