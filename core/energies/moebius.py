"""The Möbius energy without arc distances, by the midpoint rule (Section 6.1.1 of [RS21]).

E = 4·components + Σ W_IJ over ordered pairs of edges with disjoint closures (an arc counts as in `components`), with

    W_IJ = (ℓ_I ℓ_J + ⟨e_I, e_J⟩) s − 2 ⟨Δ, e_I⟩ ⟨Δ, e_J⟩ s²,   Δ = m_I − m_J,  s = 1/|Δ|²,

the density (1 − cos α)/r² at the midpoints (A. Ishizeki and T. Nagasawa, A decomposition theorem of the Möbius energy
I, Kodai Math. J. 37, 2014).  A round circle has energy 4.

The second derivative is a dense matrix.  With n = s Δ, p = ⟨Δ, e_I⟩ s, q = ⟨Δ, e_J⟩ s and g = ℓ_I ℓ_J + ⟨e_I, e_J⟩ the
second derivatives of a pair's W by e_I, e_J and Δ are

    ∂e_I ∂e_I: s ℓ_J/ℓ_I (1 − τ_I τ_Iᵀ)                ∂e_I ∂e_J: s (τ_I τ_Jᵀ + 1) − 2 n nᵀ
    ∂e_I ∂Δ:   2 (α nᵀ − s n e_Jᵀ − q s 1),            α = 4 q n − s (ℓ_J τ_I + e_J)
    ∂e_J ∂Δ:   2 (β nᵀ − s n e_Iᵀ − p s 1),            β = 4 p n − s (ℓ_I τ_J + e_I)
    ∂Δ ∂Δ:     4 (η nᵀ + n ηᵀ + a 1) − 2 s² (e_I e_Jᵀ + e_J e_Iᵀ),
               η = (g s − 6 p q) n + 2 s (q e_I + p e_J),   a = s (2 p q − g s/2).

Vertices enter through e_I = P(I↑) − P(I↓) and c_I = P(I↑) + P(I↓) = 2 m_I, so ∂c_I = ∂Δ/2 and ∂c_J = −∂Δ/2.
"""

from dataclasses import dataclass, field
from itertools import product
from typing import NamedTuple

import numpy as np

from ..base.arguments import checked_fields
from ..base.types import FloatArray, IntArray
from ..curve import Curve, Mesh
from .components import ComponentShares
from .edge_pairs import ROWS_TIMES_COLUMNS, EdgePairIndices, SteppedCurve, Tile, change, pair_tiles, row_tiles
from .moebius_pairs import Edges, Pairs, PartnerSums
from .quadrature import MIDPOINT

CONSTANT = 4.0  # of a closed component


@checked_fields
@dataclass(frozen=True, eq=False)
class MoebiusEnergy:
    """The plain midpoint sum, reported as ``moebius``, without pairs of edges that another term replaces."""

    without: EdgePairIndices | None = field(default=None, repr=False)
    name = "moebius"
    rule = MIDPOINT
    scale_exponent = 0.0
    moebius_invariant = True
    contains_midpoint_pairs = True
    description = "Möbius energy without arc distances, midpoint rule (Ishizeki–Nagasawa density)"

    def leaving_out(self, pairs: EdgePairIndices) -> "MoebiusEnergy":
        """The same sum without some pairs of edges."""
        return MoebiusEnergy(pairs)

    def value(self, curve: Curve) -> float:
        """Energy E of the curve; 4 for a regular polygon."""
        edges = Edges.of(curve)
        tiles = pair_tiles(curve.mesh, self.without)
        return energy_of_pairs(curve, sum(Pairs.of(edges, tile).energy() for tile in tiles))

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        """Energy and its derivative with respect to the vertices, shape (n, m)."""
        edges = Edges.of(curve)
        total, sums = 0.0, PartnerSums.zeros(edges.vectors)
        for tile in pair_tiles(curve.mesh, self.without):
            pairs = Pairs.of(edges, tile)
            total += pairs.energy()
            sums.add(tile.rows, tile.columns, pairs.coefficients(), edges.vectors)
        at_vertices = sums.derivatives(edges.vectors).at_vertices(curve.mesh, edges.tau)
        derivative = 2.0 * at_vertices + CONSTANT * ComponentShares(curve).derivative()
        return energy_of_pairs(curve, total), derivative

    def row_energies(self, curve: Curve, rows: IntArray) -> FloatArray:
        """Σ_J W_IJ for some edges I, shape (rows,): over all edges these add up to E without the components' shares."""
        edges = Edges.of(curve)
        return np.concatenate(
            [Pairs.of(edges, tile).row_energies() for tile in row_tiles(curve.mesh, rows, self.without)]
        )

    def hessian(self, curve: Curve) -> FloatArray:
        """Second derivative D²E, symmetric, shape (n·m, n·m), in the order of ``vertices.ravel()``."""
        matrix = hessian(curve, self.without)
        columns, shares = ComponentShares(curve).hessian_columns()
        matrix[:, columns] += CONSTANT * shares
        return matrix

    def hessian_product(self, curve: Curve, v: FloatArray) -> FloatArray:
        """D²E v for ``v`` of shape (n, m), without forming the matrix; shape (n, m)."""
        edges = Edges.of(SteppedCurve(curve, v))
        sums = PartnerSums.zeros(edges.vectors)
        for tile in pair_tiles(curve.mesh, self.without, ROWS_TIMES_COLUMNS // 2):
            sums.add(tile.rows, tile.columns, Pairs.of(edges, tile).coefficients(), edges.vectors)
        at_vertices = sums.derivatives(edges.vectors).at_vertices(curve.mesh, edges.tau)
        return 2.0 * change(at_vertices) + CONSTANT * ComponentShares(curve).second_derivative(v)


def energy_of_pairs(curve: Curve, pairs: float) -> float:
    """The energy from the sum over unordered pairs."""
    return CONSTANT * ComponentShares(curve).value() + 2.0 * pairs


def moebius_by_length(curve: Curve) -> FloatArray:
    """(Σ_J W_IJ)/ℓ_I, energy per length of each edge, (edges,), in 1/length; without the components' shares."""
    return np.asarray(MoebiusEnergy().row_energies(curve, np.arange(curve.mesh.edges)) / curve.edge_lengths)


class OwnBlocks(NamedTuple):
    """Second derivatives by one edge's own e and c, summed over its partners; each of shape (edges, m, m)."""

    ee: FloatArray
    ec: FloatArray
    cc: FloatArray

    @classmethod
    def zeros(cls, edges: int, m: int) -> "OwnBlocks":
        return cls(*(np.zeros((edges, m, m)) for _ in range(3)))

    def add_to(self, matrix: FloatArray, mesh: Mesh, factor: float) -> None:
        """Add ``factor`` times the blocks to a matrix of shape (n, m, n, m)."""
        even = factor * (self.ec + self.ec.transpose(0, 2, 1))
        odd = factor * (self.ec - self.ec.transpose(0, 2, 1))
        same, other = factor * (self.cc + self.ee), factor * (self.cc - self.ee)
        t, h = mesh.tails, mesh.heads
        # no vertex is the tail of two edges or the head of two, so no index repeats within a statement
        matrix[h, :, h, :] += same + even
        matrix[t, :, t, :] += same - even
        matrix[h, :, t, :] += other + odd
        matrix[t, :, h, :] += other - odd


class CouplingPlanes:
    """Blocks that couple two edges I ≠ J, collected as one (n, n) plane for each two coordinates.

    Pairs are given once; `symmetric_matrix` adds the transposed blocks.  In the planes the tail of edge I has the
    number I, and vertices where arcs end come last, so that blocks of edges are blocks of the planes.
    """

    def __init__(self, curve: Curve) -> None:
        n, m = curve.vertices.shape
        self.mesh = curve.mesh
        self.planes = np.zeros((m, m, n, n))
        self._numbers = np.empty(n, dtype=np.intp)
        self._numbers[np.concatenate([curve.mesh.tails, curve.mesh.ends[:, 1]])] = np.arange(n)
        self._heads = self._numbers[curve.mesh.heads]

    def add(self, k: int, j: int, tile: Tile, ee: FloatArray, ec: FloatArray, fc: FloatArray, cc: FloatArray) -> None:
        """Add the entries for coordinate k of edge I (rows) and coordinate j of edge J (columns) of a tile.

        For a function of e_I, e_J and Δ = (c_I − c_J)/2 they are, all of shape (rows, columns), the derivatives
        ∂e_I ∂e_J, ∂e_I ∂Δ/2, ∂Δ/2 ∂e_J and ∂Δ/2 ∂Δ/2.  They are overwritten.
        """
        rows = tile.rows
        even, odd = ee - cc, ec - fc
        ee += cc
        ec += fc
        self._add_rows(self.planes[k, j], rows, tile, even + odd, ec - ee)
        even -= odd
        ee += ec
        self._add_rows(self.planes[k, j], self._heads[rows], tile, np.negative(ee, out=ee), even)

    def _add_rows(
        self, plane: FloatArray, rows: slice | IntArray, tile: Tile, at_tails: FloatArray, at_heads: FloatArray
    ) -> None:
        """Add entries for the tails and for the heads of the tile's columns to rows of a plane."""
        first = tile.columns.start
        for last in self.mesh.edge_offsets[1:] - 1:
            # the head of a component's last edge is not the tail of the next one
            if last >= first:
                plane[rows, self._heads[last]] += at_heads[:, last - first]
                at_heads[:, last - first] = 0.0
        at_tails[:, 1:] += at_heads[:, :-1]
        plane[rows, tile.columns] += at_tails

    def symmetric_matrix(self, own: OwnBlocks, factor: float) -> FloatArray:
        """``factor`` times the sum of all blocks, with the transposed ones; shape (n·m, n·m)."""
        m, _, n, _ = self.planes.shape
        matrix = np.empty((n, m, n, m))
        for k in range(m):
            for j in range(m):
                np.add(self.planes[k, j], self.planes[j, k].T, out=matrix[:, k, :, j])
        matrix *= factor
        if not self.mesh.all_closed:  # else this would be a copy
            matrix = matrix[self._numbers][:, :, self._numbers]
        own.add_to(matrix, self.mesh, factor)
        return matrix.reshape(n * m, n * m)


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
        rows, columns = tile.rows, tile.columns
        e, tau = _column(edges.vectors.e[rows]), _column(edges.tau[rows])
        f, sigma = _row(edges.vectors.e[columns]), _row(edges.tau[columns])
        g, p, q, s = pairs
        n = _column(edges.vectors.m[rows]) - _row(edges.vectors.m[columns])
        n *= s
        # α, β and η, shapes (m, rows, columns), and a, shape (rows, columns)
        ell_i, ell_j = edges.vectors.ell[rows, None], edges.vectors.ell[columns]
        alpha = (4.0 * q) * n - s * (ell_j * tau + f)
        beta = (4.0 * p) * n - s * (ell_i * sigma + e)
        gs, pq = g * s, p * q
        eta = (gs - 6.0 * pq) * n + (2.0 * s * q) * e + (2.0 * s * p) * f
        a = s * (2.0 * pq - 0.5 * gs)
        sn, ps, qs, s2 = s * n, p * s, q * s, 0.5 * s * s
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
    normal = np.eye(curve.dimension) - edges.tau[:, :, None] * edges.tau[:, None, :]
    own.ee[...] = (lengths / edges.vectors.ell)[:, None, None] * normal
    return coupling.symmetric_matrix(own, 2.0)  # the energy counts ordered pairs


def _column(vectors: FloatArray) -> FloatArray:
    """Coordinates of the tile's rows, (m, rows, 1)."""
    return vectors.T[:, :, None]


def _row(vectors: FloatArray) -> FloatArray:
    """Coordinates of the tile's columns, (m, 1, columns)."""
    return vectors.T[:, None, :]
