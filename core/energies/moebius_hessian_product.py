"""D²E v of the default energy: the derivative of its derivative along v, without the matrix.

A dot is the derivative along v: ė_I, ṁ_I the edge differences and midpoint values of v, Δ̇ = ṁ_I − ṁ_J.  With
the scalars s, p, q, g of a pair and u = 2 s ⟨Δ, Δ̇⟩,

    ṡ = −s u,   ṗ = s ⟨Δ, e_I⟩˙ − p u,   q̇ = s ⟨Δ, e_J⟩˙ − q u,   ġ = ⟨ė_I, e_J⟩ + ⟨e_I, ė_J⟩ + ℓ̇_I ℓ_J + ℓ_I ℓ̇_J.
"""

from typing import NamedTuple

import numpy as np

from ..curve import Curve
from ..curve.tiles import EdgePairIndices, Tile, pair_tiles
from ..types import FloatArray
from .moebius_pairs import Coefficients, DerivativeSums, Edges, Pairs, Vectors


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
