"""What holds a rope of radius 1 open: strands two radii apart, and corners that bend no tighter than one.

    c = d − 2 ≥ 0          for pairs of edges at distance d, whose closest points are π or more apart along the curve
    c = (1 − κ²)/2 ≥ 0     for both edges at every corner of angle θ, with κ = 2 tan(θ/2)/ℓ

So the thickness is 1 or more (Rawdon, *Experimental Mathematics* 12, 2003).  Both are functions of a pair of edges:
`EdgePairs` has their chain rule.
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from ..base import FloatArray, IntArray, dot
from ..curve import Curve, Mesh
from ..curve.distances import arc_distance_of_points
from ..energies.edge_pairs import E, EdgePairs, F, Jet, change, scatter_first, scatter_second
from ..energies.rope import closest, distance


@dataclass(frozen=True, eq=False)
class Contacts:
    """Constraints on a mesh, by the numbers of their edges: first those of strands, then those of corners."""

    mesh: Mesh
    i: IntArray
    j: IntArray
    strands: int

    @classmethod
    def near(cls, curve: Curve, margin: float) -> "Contacts":
        """All corners, and the pairs of edges that are nearer than 2 and a margin, the first edge the smaller one."""
        mesh, ell, reach = curve.mesh, curve.edge_lengths, 2.0 + margin
        i, j = cKDTree(curve.midpoints).query_pairs(reach + float(ell.max()), output_type="ndarray").T
        chord, s, t = closest(EdgePairs.of(mesh, curve.vertices, i, j))
        arc = arc_distance_of_points(curve, i, (s + 0.5) * ell[i], j, (t + 0.5) * ell[j])
        kept = (dot(chord, chord) < reach * reach) & (arc >= np.pi)
        i, j, before, after = i[kept], j[kept], mesh.incoming[mesh.inner], mesh.outgoing[mesh.inner]
        return cls(mesh, np.concatenate([i, before, before]), np.concatenate([j, after, after]), len(i))

    def values(self, vertices: FloatArray) -> FloatArray:
        """All c, shape (constraints,)."""
        return self.jet(EdgePairs.of(self.mesh, vertices, self.i, self.j)).value

    def jet(self, pairs: EdgePairs) -> Jet:
        """All c and their derivatives by (Δ, e, f), from the pairs of edges, real or after complex steps."""
        k, middle = self.strands, (len(self.i) + self.strands) // 2
        apart = distance(EdgePairs(*(x[:k] for x in pairs)))
        corners = EdgePairs(*(x[k:middle] for x in pairs))
        ee, ff, ef = corners.inner(E, E), corners.inner(F, F), corners.inner(E, F)
        both = (ee * ff).sqrt()
        tangent = (both - ef) * (both + ef).reciprocal()  # tan²(θ/2)
        bends = [tangent * each.reciprocal() for each in (ee, ff)]
        return Jet(
            np.concatenate([apart.value - 2.0, *(0.5 - 2.0 * bend.value for bend in bends)]),
            np.concatenate([apart.first, *(-2.0 * bend.first for bend in bends)]),
        )

    def sum_of(self, first: FloatArray, weights: FloatArray) -> FloatArray:
        """Σ w ∇c, shape (n, m), from derivatives by (Δ, e, f)."""
        return scatter_first(self.mesh, self.i, self.j, weights[:, None] * first)

    def along(self, first: FloatArray, v: FloatArray) -> FloatArray:
        """⟨∇c, v⟩ for a field v, shape (n, m): how fast constraints change, shape (constraints,)."""
        return np.asarray(np.sum(first * np.hstack(EdgePairs.of(self.mesh, v, self.i, self.j)), axis=1))

    def second(
        self, vertices: FloatArray, first: FloatArray, z: FloatArray, k: FloatArray
    ) -> tuple[sp.csr_array, sp.csr_array]:
        """Σ k ∇c ∇cᵀ and −Σ z D²c, sparse (n·m, n·m), from those constraints that are felt."""
        felt = (z != 0.0) | (k != 0.0)
        felt[self.strands :] = np.tile(felt[self.strands :].reshape(2, -1).any(axis=0), 2)  # both edges of a corner
        own = Contacts(self.mesh, self.i[felt], self.j[felt], int(felt[: self.strands].sum()))
        first, z, k = first[felt], z[felt, None, None], k[felt, None, None]
        pairs = EdgePairs.of(self.mesh, vertices, own.i, own.j)
        second = np.stack([change(own.jet(each).first) for each in pairs.along_coordinates()], axis=2)
        curved, stiff = -0.5 * z * (second + second.transpose(0, 2, 1)), k * first[:, :, None] * first[:, None, :]
        return tuple(scatter_second(self.mesh, own.i, own.j, each) for each in (stiff, curved))
