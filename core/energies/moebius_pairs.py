"""The default energy's pairs of edges: their scalars and the sums that make the derivative, as thin matrix products."""

from typing import NamedTuple

import numpy as np
from scipy.spatial.distance import cdist

from ..curve import Curve, Mesh
from ..curve.tiles import RowTile, Tile
from ..types import FloatArray


class Vectors(NamedTuple):
    """What the derivative is linear in: edge vectors with lengths, midpoints with ones; each (edges, m + 1)."""

    e_ell: FloatArray
    m_one: FloatArray

    @classmethod
    def of(cls, e: FloatArray, ell: FloatArray, m: FloatArray) -> "Vectors":
        """Stack edge vectors (edges, m), lengths (edges,) and midpoints (edges, m), these taken from their mean.

        Products of coordinates lose digits far from the origin, so the origin comes to the curve.
        """
        return cls(np.column_stack([e, ell]), np.column_stack([m - m.mean(axis=0), np.ones(len(m))]))

    @property
    def e(self) -> FloatArray:
        """Edge vectors; shape (edges, m)."""
        return self.e_ell[:, :-1]

    @property
    def m(self) -> FloatArray:
        """Midpoints from their mean; shape (edges, m)."""
        return self.m_one[:, :-1]

    @property
    def ell(self) -> FloatArray:
        """Lengths; shape (edges,)."""
        return self.e_ell[:, -1]


class Edges(NamedTuple):
    """The edges of a curve."""

    vectors: Vectors
    tau: FloatArray  # unit tangents, (edges, m)
    foot: FloatArray  # (−e, ⟨m, e⟩), (edges, m + 1): times (m_J, 1) it is ⟨m_I − m_J, e_I⟩

    @classmethod
    def of(cls, curve: Curve) -> "Edges":
        e, ell = curve.edge_vectors, curve.edge_lengths
        vectors = Vectors.of(e, ell, curve.midpoints)
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
        # distances from differences: strands may be close
        r2 = cdist(edges.vectors.m[rows], edges.vectors.m[columns], "sqeuclidean")
        r2[tile.excluded] = np.inf
        s = np.divide(1.0, r2, out=r2)
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
        """The derivative's coefficients; overwrites g."""
        g, p, q, s = self
        b, c = q * s, p * s
        a = 4.0 * p
        a *= b
        g *= s
        g *= s
        a -= g
        return Coefficients(s, a, b, c)


class Coefficients(NamedTuple):
    """Coefficients of a tile's derivative, each of shape (rows, columns).

    ∂W/∂e_I = s (ℓ_J τ_I + e_J) − 2 b Δ,   ∂W/∂Δ = 2 (a Δ − b e_I − c e_J).
    """

    s: FloatArray
    a: FloatArray  # 4 p q s − g s²
    b: FloatArray  # q s
    c: FloatArray  # p s


class DerivativeSums(NamedTuple):
    """Sums over the partners of each edge: ∂E/∂e without the terms along τ, ∂E/∂m, and ∂E/∂ℓ, which is along τ."""

    by_edge: FloatArray
    by_midpoint: FloatArray
    by_length: FloatArray

    @classmethod
    def zeros(cls, edges: int, m: int) -> "DerivativeSums":
        return cls(np.zeros((edges, m)), np.zeros((edges, m)), np.zeros(edges))

    def add(self, rows: slice, columns: slice, coefficients: Coefficients, vectors: Vectors) -> None:
        """Add the pairs of some rows and columns, seen from I and seen from J."""
        s, a, b, c = coefficients
        self._add_side(rows, columns, Coefficients(s, a, b, c), 1.0, vectors)
        # if the edges change places Δ changes its sign, and b and c change places and signs
        self._add_side(columns, rows, Coefficients(s.T, a.T, c.T, b.T), -1.0, vectors)

    def _add_side(self, own: slice, other: slice, coefficients: Coefficients, sign: float, vectors: Vectors) -> None:
        s, a, b, c = coefficients
        e, m = vectors.e[own], vectors.m[own]
        d = m.shape[1]
        am, bm = a @ vectors.m_one[other], b @ vectors.m_one[other]
        ce, sl = c @ vectors.e[other], s @ vectors.e_ell[other]
        # Σ_J a_IJ (m_I − m_J) = (Σ_J a_IJ) m_I − Σ_J a_IJ m_J
        self.by_midpoint[own] += 2.0 * (am[:, d:] * m - am[:, :d] - sign * (bm[:, d:] * e + ce))
        self.by_edge[own] += sl[:, :d] - (2.0 * sign) * (bm[:, d:] * m - bm[:, :d])
        self.by_length[own] += sl[:, d]

    def row_energies(self, vectors: Vectors) -> FloatArray:
        """Σ_J W_IJ for each edge I, shape (edges,): the derivative itself tells, W_IJ being linear in (e_I, ℓ_I)."""
        return np.asarray(np.einsum("ij,ij->i", self.by_edge, vectors.e) + self.by_length * vectors.ell)

    def at_vertices(self, mesh: Mesh, tau: FloatArray) -> FloatArray:
        """The derivative with respect to the vertices, shape (n, m)."""
        by_edge, half = self.by_edge + self.by_length[:, None] * tau, 0.5 * self.by_midpoint
        return mesh.scatter(half - by_edge, half + by_edge)
