"""The Möbius energy without arc distances, by the midpoint rule (Section 6.1.1 of [RS21]).

E = 4·components + Σ W_IJ over ordered pairs of edges with disjoint closures, with

    W_IJ = (ℓ_I ℓ_J + ⟨e_I, e_J⟩) s − 2 ⟨Δ, e_I⟩ ⟨Δ, e_J⟩ s²,   Δ = m_I − m_J,  s = 1/|Δ|²,

Ishizeki and Nagasawa's density (1 − cos α)/r² at the midpoints.  A round circle has energy 4.
"""

from typing import NamedTuple

import numpy as np

from ..curve import Curve
from ..curve.tiles import Tile, pair_tiles
from ..types import FloatArray


class MoebiusEnergy:
    """The plain midpoint sum, the energy that is reported as ``moebius``."""

    name = "moebius"
    description = "Möbius energy without arc distances, midpoint rule (Ishizeki–Nagasawa density)"

    def value(self, curve: Curve) -> float:
        """Energy E of the curve; 4 for a regular polygon."""
        total = 0.0
        for tile in pair_tiles(curve.mesh):
            pairs = _pairs(curve, tile)
            total += float(np.sum(_contributions(pairs)))
        return 4.0 * len(curve.mesh.component_sizes) + 2.0 * total

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        """Energy and its derivative with respect to the vertices, shape (n, m)."""
        total = 0.0
        by_edge = np.zeros_like(curve.vertices)  # ∂E/∂e_I
        by_midpoint = np.zeros_like(curve.vertices)  # ∂E/∂m_I
        for tile in pair_tiles(curve.mesh):
            pairs = _pairs(curve, tile)
            total += float(np.sum(_contributions(pairs)))
            _add_derivatives(curve, tile, pairs, by_edge, by_midpoint)
        energy = 4.0 * len(curve.mesh.component_sizes) + 2.0 * total
        return energy, 2.0 * curve.mesh.scatter(0.5 * by_midpoint - by_edge, 0.5 * by_midpoint + by_edge)


class _Pairs(NamedTuple):
    """Scalars of the edge pairs of one tile, each of shape (rows, columns)."""

    g: FloatArray  # ℓ_I ℓ_J + ⟨e_I, e_J⟩
    p: FloatArray  # ⟨Δ, e_I⟩ s
    q: FloatArray  # ⟨Δ, e_J⟩ s
    s: FloatArray  # 1/|Δ|², 0 for excluded pairs


def _pairs(curve: Curve, tile: Tile) -> _Pairs:
    e, m, ell = curve.edge_vectors, curve.midpoints, curve.edge_lengths
    rows, columns = tile.rows, tile.columns
    shape = tile.excluded.shape
    r2, p, q, scratch = np.zeros(shape), np.zeros(shape), np.zeros(shape), np.empty(shape)
    for k in range(curve.dimension):
        # differences of coordinates first: strands may be close and far from the origin
        delta = np.subtract.outer(m[rows, k], m[columns, k])
        r2 += np.multiply(delta, delta, out=scratch)
        p += np.multiply(delta, e[rows, k, None], out=scratch)
        q += np.multiply(delta, e[None, columns, k], out=scratch)
    r2[tile.excluded] = np.inf
    s = np.divide(1.0, r2, out=r2)
    p *= s
    q *= s
    g = e[rows] @ e[columns].T
    g += np.multiply.outer(ell[rows], ell[columns])
    return _Pairs(g, p, q, s)


def _contributions(pairs: _Pairs) -> FloatArray:
    """W_IJ of every pair of the tile."""
    g, p, q, s = pairs
    w = g * s
    w -= 2.0 * p * q
    return w


def _add_derivatives(curve: Curve, tile: Tile, pairs: _Pairs, by_edge: FloatArray, by_midpoint: FloatArray) -> None:
    """Add ∂W/∂e and ∂W/∂m of the tile's pairs, as products of pair matrices with thin edge matrices.

    ∂W/∂e_I = (ℓ_J τ_I + e_J) s − 2 q s Δ and ∂W/∂Δ = A Δ − 2 s (q e_I + p e_J) with
    A = 8 p q s − 2 g s² (p and q here already carry one factor s).
    """
    g, p, q, s = pairs
    qs = 2.0 * q * s
    ps = 2.0 * p * s
    a = 2.0 * p
    a *= qs
    a *= 2.0
    g *= s
    g *= s
    g *= 2.0
    a -= g
    rows, columns = tile.rows, tile.columns
    e, m, ell = curve.edge_vectors, curve.midpoints, curve.edge_lengths
    tau = e / ell[:, None]
    one = np.ones((len(m), 1))
    m1 = np.hstack([m, one])  # (Δ-weighted sums need Σ_J c_IJ (m_I − m_J) = (Σ c) m_I − c m)
    el = np.hstack([e, ell[:, None]])
    d = curve.dimension

    am, qm, pe, sl = a @ m1[columns], qs @ m1[columns], ps @ e[columns], s @ el[columns]
    by_midpoint[rows] += am[:, d:] * m[rows] - am[:, :d] - qm[:, d:] * e[rows] - pe
    by_edge[rows] += sl[:, d:] * tau[rows] + sl[:, :d] - (qm[:, d:] * m[rows] - qm[:, :d])

    am, pm, qe, sl = a.T @ m1[rows], ps.T @ m1[rows], qs.T @ e[rows], s.T @ el[rows]
    by_midpoint[columns] += am[:, d:] * m[columns] - am[:, :d] + pm[:, d:] * e[columns] + qe
    by_edge[columns] += sl[:, d:] * tau[columns] + sl[:, :d] + (pm[:, d:] * m[columns] - pm[:, :d])
