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

from dataclasses import dataclass, field, replace
from itertools import product
from typing import NamedTuple, Self

import numpy as np
from scipy.spatial.distance import cdist

from ..base import BoolArray, FloatArray, IntArray, checked_fields, dot
from ..curve import Curve, Mesh
from .components import CONSTANT, ComponentShares, energy_of_pairs
from .edge_pairs import ROWS_TIMES_COLUMNS, EdgePairIndices, SteppedCurve, change, half_changes, pair_tiles
from .quadrature import MIDPOINT

Coefficients = tuple[FloatArray, FloatArray, FloatArray, FloatArray]
"""s, a, b and c of pairs: ∂W/∂e_I = s (ℓ_J τ_I + e_J) − 2 b Δ and ∂W/∂Δ = 2 (a Δ − b e_I − c e_J)."""


class Edges(NamedTuple):
    """The edges of a curve; the derivative is linear in edges e, lengths ℓ and midpoints m."""

    e_ell: FloatArray  # e and ℓ; (edges, m + 1)
    m_one: FloatArray  # midpoints, from their mean, and ones; (edges, m + 1)
    tau: FloatArray  # unit tangents; (edges, m)
    foot: FloatArray  # (−e, ⟨m, e⟩), (edges, m + 1): times (m_J, 1) it is ⟨m_I − m_J, e_I⟩
    e: FloatArray  # parts of these arrays
    ell: FloatArray
    m: FloatArray

    @classmethod
    def of(cls, curve: Curve) -> "Edges":
        # products of coordinates lose digits far from the origin, so the curve is moved to the origin
        e, ell, m = curve.edge_vectors, curve.edge_lengths, curve.midpoints - curve.midpoints.mean(axis=0)
        foot = np.column_stack([-e, dot(m, e)])
        e_ell, m_one = np.column_stack([e, ell]), np.column_stack([m, np.ones(len(m))])
        return cls(e_ell, m_one, e / ell[:, None], foot, e_ell[:, :-1], e_ell[:, -1], m_one[:, :-1])


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
        return dot(self.by_edge, edges.e) + self.by_length * edges.ell

    def at_vertices(self, mesh: Mesh, tau: FloatArray) -> FloatArray:
        """The derivative with respect to the vertices, shape (n, m)."""
        by_edge, half = self.by_edge + self.by_length[:, None] * tau, 0.5 * self.by_midpoint
        return mesh.scatter(half - by_edge, half + by_edge)


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

    def leaving_out(self, pairs: EdgePairIndices) -> Self:
        """The same sum without some pairs of edges, such as `replaced_pairs`."""
        return replace(self, without=pairs)

    def value(self, curve: Curve) -> float:
        """Energy E of the curve; 4 for a regular polygon."""
        edges = Edges.of(curve)
        tiles = pair_tiles(curve.mesh, self.without)
        return energy_of_pairs(curve, sum(Pairs.of(edges, *tile).energy() for tile in tiles))

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        """Energy and its derivative with respect to the vertices, shape (n, m)."""
        edges = Edges.of(curve)
        total, sums = 0.0, PartnerSums.zeros(edges)
        for tile in pair_tiles(curve.mesh, self.without):
            pairs = Pairs.of(edges, *tile)
            total += pairs.energy()
            sums.add(tile.rows, tile.columns, pairs.coefficients(), edges)
        derivative = 2.0 * sums.derivatives(edges).at_vertices(curve.mesh, edges.tau)
        return energy_of_pairs(curve, total), derivative + CONSTANT * ComponentShares(curve).derivative()

    def row_energies(self, curve: Curve, rows: IntArray) -> FloatArray:
        """Σ_J W_IJ for some edges I, shape (rows,): over all edges these add up to E without the components' shares."""
        mesh, edges, found = curve.mesh, Edges.of(curve), []
        height = max(1, ROWS_TIMES_COLUMNS // mesh.edges)
        for first in range(0, len(rows), height):
            own = rows[first : first + height]
            excluded = np.zeros((len(own), mesh.edges), dtype=np.bool_)
            for neighbour in (own, mesh.next[own], mesh.previous[own]):
                excluded[np.arange(len(own)), neighbour] = True
            for i, j in () if self.without is None else (self.without, self.without[::-1]):
                row, pair = np.nonzero(own[:, None] == i)
                excluded[row, j[pair]] = True
            g, p, q, s = Pairs.of(edges, own, slice(None), excluded)
            found.append(dot(g, s) - 2.0 * dot(p, q))
        return np.concatenate(found)

    def hessian_product(self, curve: Curve, v: FloatArray) -> FloatArray:
        """D²E v for ``v`` of shape (n, m), by a complex step of the derivative; shape (n, m)."""
        edges = Edges.of(SteppedCurve(curve, v))
        sums = PartnerSums.zeros(edges)
        for tile in pair_tiles(curve.mesh, self.without, ROWS_TIMES_COLUMNS // 2):
            sums.add(tile.rows, tile.columns, Pairs.of(edges, *tile).coefficients(), edges)
        at_vertices = sums.derivatives(edges).at_vertices(curve.mesh, edges.tau)
        return 2.0 * change(at_vertices) + CONSTANT * ComponentShares(curve).second_derivative(v)

    def hessian(self, curve: Curve) -> FloatArray:
        """Second derivative D²E, symmetric, shape (n·m, n·m), in the order of ``vertices.ravel()``."""
        edges, mesh, (n, m) = Edges.of(curve), curve.mesh, curve.vertices.shape
        own, lengths = OwnBlocks.zeros(mesh.edges, m), np.zeros(mesh.edges)
        # What couples two edges is collected in one plane for each two coordinates.  There the tail of edge I has the
        # number I, and vertices where arcs end come last, so that blocks of edges are blocks of planes.
        planes, number = np.zeros((m, m, n, n)), np.empty(n, dtype=np.intp)
        number[np.concatenate([mesh.tails, mesh.ends[:, 1]])] = np.arange(n)
        head = number[mesh.heads]
        for tile in pair_tiles(mesh, self.without):
            rows, columns, first = tile.rows, tile.columns, tile.columns.start
            g, p, q, s = Pairs.of(edges, *tile)
            ell_i, ell_j = edges.ell[rows, None], edges.ell[columns]
            lengths[rows] += s @ ell_j
            lengths[columns] += edges.ell[rows] @ s
            # vectors of the rows' edges have shape (m, rows, 1), those of the columns' (m, 1, columns)
            e, tau, mid = (x[rows].T[:, :, None] for x in (edges.e, edges.tau, edges.m))
            f, sigma, other_mid = (x[columns].T[:, None, :] for x in (edges.e, edges.tau, edges.m))
            nu = mid - other_mid
            nu *= s
            gs, pq, sn, ps, qs, s2 = g * s, p * q, s * nu, p * s, q * s, 0.5 * s * s
            alpha = (4.0 * q) * nu - s * (ell_j * tau + f)
            beta = (4.0 * p) * nu - s * (ell_i * sigma + e)
            eta = (gs - 6.0 * pq) * nu + (2.0 * qs) * e + (2.0 * ps) * f
            a = s * (2.0 * pq - 0.5 * gs)
            for k, j in product(range(m), repeat=2):
                ee = s * (tau[k] * sigma[j]) - 2.0 * nu[k] * nu[j]  # ∂e_I ∂e_J, coordinates k of e_I and j of e_J
                ec = alpha[k] * nu[j] - sn[k] * f[j]  # ∂e_I ∂Δ/2
                fc = beta[j] * nu[k] - sn[j] * e[k]  # ∂Δ/2 ∂e_J
                cc = eta[k] * nu[j] + nu[k] * eta[j] - s2 * (e[k] * f[j] + f[k] * e[j])  # ∂Δ/2 ∂Δ/2
                if k == j:
                    ee += s
                    ec -= qs
                    fc -= ps
                    cc += a
                own.ec[rows, k, j] += ec.sum(axis=1)
                own.ec[columns, j, k] -= fc.sum(axis=0)
                own.cc[rows, k, j] += cc.sum(axis=1)
                own.cc[columns, k, j] += cc.sum(axis=0)
                # by ends of edges, signs σ = 1 for heads and −1 for tails: σ_I σ_J ee − σ_I ec + σ_J fc − cc
                even, odd = ee - cc, ec - fc
                ee += cc
                ec += fc
                of_tails = rows, even + odd, ec - ee
                even -= odd
                ee += ec
                for places, at_tails, at_heads in (of_tails, (head[rows], np.negative(ee, out=ee), even)):
                    # the heads of edges are the tails of the next ones, but for a component's last one
                    for last in mesh.edge_offsets[1:] - 1:
                        if last >= first:
                            planes[k, j, places, head[last]] += at_heads[:, last - first]
                            at_heads[:, last - first] = 0.0
                    at_tails[:, 1:] += at_heads[:, :-1]
                    planes[k, j, places, columns] += at_tails
        normal = np.eye(m) - edges.tau[:, :, None] * edges.tau[:, None, :]
        own.ee[...] = (lengths / edges.ell)[:, None, None] * normal
        matrix = np.empty((n, m, n, m))
        for k, j in product(range(m), repeat=2):
            np.add(planes[k, j], planes[j, k].T, out=matrix[:, k, :, j])
        matrix *= 2.0  # the energy counts ordered pairs
        if not mesh.all_closed:  # else this would be a copy
            matrix = matrix[number][:, :, number]
        own.add_to(matrix, mesh, 2.0)
        coordinates, shares = ComponentShares(curve).hessian_columns()
        hessian = matrix.reshape(n * m, n * m)
        hessian[:, coordinates] += CONSTANT * shares
        return hessian


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
