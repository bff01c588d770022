"""The second derivative of the default energy as a dense matrix (Section 6.1.1 of [RS21]).

A pair's W depends on e_I, e_J and Δ = m_I − m_J.  With s = 1/|Δ|², n = s Δ, p = ⟨Δ, e_I⟩ s, q = ⟨Δ, e_J⟩ s and
g = ℓ_I ℓ_J + ⟨e_I, e_J⟩ its second derivatives are

    ∂e_I ∂e_I: s ℓ_J/ℓ_I (1 − τ_I τ_Iᵀ)                ∂e_I ∂e_J: s (τ_I τ_Jᵀ + 1) − 2 n nᵀ
    ∂e_I ∂Δ:   2 (α nᵀ − s n e_Jᵀ − q s 1),            α = 4 q n − s (ℓ_J τ_I + e_J)
    ∂e_J ∂Δ:   2 (β nᵀ − s n e_Iᵀ − p s 1),            β = 4 p n − s (ℓ_I τ_J + e_I)
    ∂Δ ∂Δ:     4 (η nᵀ + n ηᵀ + a 1) − 2 s² (e_I e_Jᵀ + e_J e_Iᵀ),
               η = (g s − 6 p q) n + 2 s (q e_I + p e_J),   a = s (2 p q − g s/2).

Vertices enter through e_I = P(I↑) − P(I↓) and c_I = P(I↑) + P(I↓) = 2 m_I, so ∂c_I = ∂Δ/2 and ∂c_J = −∂Δ/2.
"""

from itertools import product
from typing import NamedTuple

import numpy as np

from ..curve import Curve
from ..curve.tiles import EdgePairIndices, Tile, pair_tiles
from ..types import FloatArray
from .hessian_blocks import CouplingPlanes, OwnBlocks
from .moebius_pairs import Coefficients, DerivativeSums, Edges, Pairs, Vectors


def hessian(curve: Curve, without: EdgePairIndices | None = None) -> FloatArray:
    """D² of Σ W_IJ without some pairs, shape (n·m, n·m), in the order of ``vertices.ravel()``."""
    edges = Edges.of(curve)
    coupling = CouplingPlanes(curve)
    own = OwnBlocks.zeros(*curve.edge_vectors.shape)
    lengths = np.zeros(curve.mesh.edges)  # Σ_J s_IJ ℓ_J
    for tile in pair_tiles(curve.mesh, without):
        pairs = Pairs.of(edges, tile)
        lengths[tile.rows] += pairs.s @ edges.vectors.ell[tile.columns]
        lengths[tile.columns] += edges.vectors.ell[tile.rows] @ pairs.s
        _add_tile(edges, tile, pairs, coupling, own)
    normal = np.eye(curve.dimension) - edges.tau[:, :, None] * edges.tau[:, None, :]
    own.ee[...] = (lengths / edges.vectors.ell)[:, None, None] * normal
    return coupling.symmetric_matrix(own, 2.0)  # the energy counts ordered pairs


def _add_tile(edges: Edges, tile: Tile, pairs: Pairs, coupling: CouplingPlanes, own: OwnBlocks) -> None:
    rows, columns = tile.rows, tile.columns
    e, tau = _column(edges.vectors.e[rows]), _column(edges.tau[rows])
    f, sigma = _row(edges.vectors.e[columns]), _row(edges.tau[columns])
    s = pairs.s
    n = _column(edges.vectors.m[rows]) - _row(edges.vectors.m[columns])
    n *= s
    alpha, beta, eta, a = _vectors(edges, tile, pairs, n)
    sn, ps, qs, s2 = s * n, pairs.p * s, pairs.q * s, 0.5 * s * s
    for k, j in product(range(len(n)), repeat=2):
        ee = s * (tau[k] * sigma[j]) - 2.0 * n[k] * n[j]
        ec = alpha[k] * n[j] - sn[k] * f[j]  # ∂e_I ∂Δ/2, coordinates k of e_I and j of Δ
        fc = beta[j] * n[k] - sn[j] * e[k]  # ∂e_J ∂Δ/2, coordinates j of e_J and k of Δ
        cc = eta[k] * n[j] + n[k] * eta[j] - s2 * (e[k] * f[j] + f[k] * e[j])
        if k == j:
            ee += s
            ec -= qs
            fc -= ps
            cc += a
        own.ec[rows, k, j] += ec.sum(axis=1)
        own.ec[columns, j, k] -= fc.sum(axis=0)
        own.cc[rows, k, j] += cc.sum(axis=1)
        own.cc[columns, k, j] += cc.sum(axis=0)
        coupling.add(k, j, tile, ee, ec, fc, cc)


def _vectors(
    edges: Edges, tile: Tile, pairs: Pairs, n: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """α, β and η of the tile's pairs, shapes (m, rows, columns), and a, shape (rows, columns)."""
    rows, columns = tile.rows, tile.columns
    g, p, q, s = pairs
    ell_i, ell_j = edges.vectors.ell[rows, None], edges.vectors.ell[columns]
    e, f = _column(edges.vectors.e[rows]), _row(edges.vectors.e[columns])
    alpha = (4.0 * q) * n - s * (ell_j * _column(edges.tau[rows]) + f)
    beta = (4.0 * p) * n - s * (ell_i * _row(edges.tau[columns]) + e)
    gs, pq = g * s, p * q
    eta = (gs - 6.0 * pq) * n + (2.0 * s * q) * e + (2.0 * s * p) * f
    return alpha, beta, eta, s * (2.0 * pq - 0.5 * gs)


def _column(vectors: FloatArray) -> FloatArray:
    """Coordinates of the tile's rows, (m, rows, 1)."""
    return vectors.T[:, :, None]


def _row(vectors: FloatArray) -> FloatArray:
    """Coordinates of the tile's columns, (m, 1, columns)."""
    return vectors.T[:, None, :]


def hessian_product(curve: Curve, v: FloatArray, without: EdgePairIndices | None = None) -> FloatArray:
    """D²E v for ``v`` of shape (n, m), E without some pairs; shape (n, m)."""
    edges = Edges.of(curve)
    motion = _Motion.of(curve, edges, v)
    sums = DerivativeSums.zeros(*curve.edge_vectors.shape)
    lengths = np.zeros(curve.mesh.edges)  # Σ_J s ℓ_J
    for tile in pair_tiles(curve.mesh, without):
        pairs = Pairs.of(edges, tile)
        lengths[tile.rows] += pairs.s @ edges.vectors.ell[tile.columns]
        lengths[tile.columns] += edges.vectors.ell[tile.rows] @ pairs.s
        # the sums are linear in the coefficients and in the vectors
        sums.add(tile.rows, tile.columns, motion.coefficients(pairs, tile), edges.vectors)
        sums.add(tile.rows, tile.columns, pairs.coefficients(), motion.vectors)
    turning = (motion.vectors.e - motion.vectors.ell[:, None] * edges.tau) / edges.vectors.ell[:, None]  # τ̇
    by_edge = sums.by_edge + lengths[:, None] * turning
    return 2.0 * sums._replace(by_edge=by_edge).at_vertices(curve.mesh, edges.tau)


class _Motion(NamedTuple):
    """Derivatives along v of the edges' vectors, and factors of the pairs' scalars, of 2m + 1 or 2m + 2 columns."""

    vectors: Vectors
    delta: tuple[FloatArray, FloatArray]  # their product is ⟨Δ, Δ̇⟩
    foot: tuple[FloatArray, FloatArray]  # ⟨Δ, e_I⟩˙, and −⟨Δ, e_J⟩˙ if the edges change places
    length: tuple[FloatArray, FloatArray]  # ġ

    @classmethod
    def of(cls, curve: Curve, edges: Edges, v: FloatArray) -> "_Motion":
        tails, heads = v[curve.mesh.tails], v[curve.mesh.heads]
        still, one = edges.vectors, np.ones((len(tails), 1))
        vectors = Vectors.of(heads - tails, _dot(edges.tau, heads - tails)[:, 0], 0.5 * (heads + tails))
        e, m = vectors.e, vectors.m
        outward, along = _dot(still.m, m), _dot(still.m, e) + _dot(m, still.e)
        return cls(
            vectors,
            (np.hstack([-m, -still.m, outward, one]), np.hstack([still.m, m, one, outward])),
            (np.hstack([-e, -still.e, along]), np.hstack([still.m, m, one])),
            (np.hstack([vectors.e_ell, still.e_ell]), np.hstack([still.e_ell, vectors.e_ell])),
        )

    def coefficients(self, pairs: Pairs, tile: Tile) -> Coefficients:
        """The derivatives along v of the pairs' coefficients."""
        g, p, q, s = pairs
        u = _products(self.delta, tile)
        u *= 2.0 * s
        p_dot = s * _products(self.foot, tile) - p * u
        q_dot = s * _products((self.foot[1], -self.foot[0]), tile) - q * u
        gs = g * s
        a_dot = 4.0 * (p_dot * q + p * q_dot) - s * _products(self.length, tile) + u * (2.0 * gs - 4.0 * p * q)
        return Coefficients(-s * u, s * a_dot, s * (q_dot - q * u), s * (p_dot - p * u))


def _products(factors: tuple[FloatArray, FloatArray], tile: Tile) -> FloatArray:
    return np.asarray(factors[0][tile.rows] @ factors[1][tile.columns].T)


def _dot(x: FloatArray, y: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("ij,ij->i", x, y)[:, None])
