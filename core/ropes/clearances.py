"""What ropes must keep clear of, and a barrier that sees to it.

    B = Σ w φ((x/ϱ − λ)/(c − λ)),   φ(z) = −(1 − z)² log z  up to z = 1 and 0 from there on,

over quantities x that must be at least λϱ: distances of pairs of edges, for which ϱ is the sum of their radii and
w = ℓ_I ℓ_J/(ϱ/2)², of edges from triangles of obstacles, ϱ = R and w = ℓ_I/R, and bending radii at corners, likewise.
λ is the share of the radii that is kept, and c that at which the barrier begins.  φ is that of incremental potential
contact (Li et al., ACM Trans. Graphics 39, 2020).
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

from ..base import TINY, FloatArray, IntArray, dot
from ..collision import BoxTree, near_edges, nearer_than, scaled_points, still_triangles
from ..curve import Curve, Obstacle, arc_distance_of_pairs, bending_radii
from ..energies.edge_pairs import CORNERS, EdgePairs
from ..energies.rope import bends, closest, distance, phi


class Clearances(NamedTuple):
    """k quantities in units of what is needed, x/ϱ, with their derivatives by the ends of two edges."""

    value: FloatArray  # (k,)
    first: FloatArray  # (k, 4, 3)
    vertices: IntArray  # (k, 4)
    weight: FloatArray  # (k,)
    edges: IntArray  # (k, 2); the second is the first for corners and −1 − number for triangles

    def barrier(self, share: float, begins: float) -> tuple[FloatArray, FloatArray, FloatArray]:
        """w φ of each and its first two derivatives by x/ϱ; infinite from λ down."""
        width = begins - share
        value, slope, curvature = phi((self.value - share) / width)
        return self.weight * value, self.weight * slope / width, self.weight * curvature / width**2

    def sum_first(self, slope: FloatArray, size: int) -> FloatArray:
        """Σ slope ∇x by the vertices; shape (size, 3)."""
        at, force = self.vertices.ravel(), (slope[:, None, None] * self.first).reshape(-1, 3)
        return np.stack([np.bincount(at, column, size) for column in force.T], axis=1)

    def sum_squares(self, curvature: FloatArray, size: int) -> sp.csc_array:
        """Σ curvature ∇x ∇xᵀ by the coordinates, the Gauss–Newton part of the second derivative; (3 size, 3 size)."""
        k = len(curvature)
        index = (3 * self.vertices[:, :, None] + np.arange(3)).reshape(k, 12)
        rows, columns = np.broadcast_arrays(index[:, :, None], index[:, None, :])
        row = self.first.reshape(k, 12)
        blocks = curvature[:, None, None] * row[:, :, None] * row[:, None]
        return sp.csc_array((blocks.ravel(), (rows.ravel(), columns.ravel())), shape=(3 * size, 3 * size))


def clearances(
    curve: Curve, radius: FloatArray, lengths: FloatArray, within: float, obstacles: Sequence[Obstacle] = ()
) -> Clearances:
    """All quantities below ``within`` times what they need, for ropes of a radius for each component.

    Edges of one component count if they are half a circle of the radius, or of that part of it, apart along the curve:
    those of a straight one never do.  ``lengths`` are those of edges for the weights, shape (edges,).
    """
    mesh, p = curve.mesh, curve.vertices
    own = radius[mesh.edge_component]
    reach = within * 2.0 * float(radius.max())
    points, unit = scaled_points(curve)
    found = [(i, j) for i, j, _ in near_edges(curve, points, lambda: float(np.ldexp(reach, -unit)) ** 2)]
    none = np.zeros(0, dtype=np.intp)
    i, j = (np.concatenate(each) for each in zip((none, none), *found, strict=True))
    along = arc_distance_of_pairs(curve, i, j, 0.5) - 0.5 * (curve.edge_lengths[i] + curve.edge_lengths[j])
    far = along > np.pi * min(within, 1.0) * own[i]
    i, j = i[far], j[far]
    need = own[i] + own[j]
    parts = [(distance(EdgePairs.of(mesh, p, i, j)), i, j, need, lengths[i] * lengths[j] / (0.5 * need) ** 2)]
    bent = mesh.inner[(bending_radii(curve) < within * radius[mesh.component])[mesh.inner]]
    before, after = mesh.incoming[bent], mesh.outgoing[bent]
    for jet, edge in zip(bends(EdgePairs.of(mesh, p, before, after)), (before, after), strict=True):
        parts.append((jet, before, after, own[edge], lengths[edge] / own[edge]))
    made = []
    for jet, i, j, need, weight in parts:
        kept = jet.value < within * need
        i, j, need = i[kept], j[kept], need[kept]
        ends = np.stack([mesh.tails[i], mesh.heads[i], mesh.tails[j], mesh.heads[j]], axis=1)
        by_ends = CORNERS @ jet.first[kept].reshape(-1, 3, 3) / need[:, None, None]
        made.append(Clearances(jet.value[kept] / need, by_ends, ends, weight[kept], np.stack([i, j], axis=1)))
    if obstacles:
        made.append(_with_obstacles(curve, own, lengths, within, obstacles))
    return Clearances(*(np.concatenate(each) for each in zip(*made, strict=True)))


def _with_obstacles(
    curve: Curve, radius: FloatArray, lengths: FloatArray, within: float, obstacles: Sequence[Obstacle]
) -> Clearances:
    """The distances of edges, with radii each, from triangles."""
    mesh = curve.mesh
    reach = within * float(radius.max())
    exponent = int(np.frexp(max(np.abs(curve.vertices).max(), *(each.size for each in obstacles)))[1])
    still = still_triangles(tuple(obstacles), exponent)
    points, nearest = np.ldexp(curve.vertices.T, -exponent, order="C"), float(np.ldexp(reach, -exponent))
    tree = BoxTree.build(mesh, points)
    found = [*tree.pairs_with(still.tree, nearer_than(lambda: nearest**2))]
    none = np.zeros(0, dtype=np.intp)
    a, b = (np.concatenate(each) for each in zip((none, none), *found, strict=True))
    edge, triangle = tree.order[a], still.tree.order[b]
    corners = still.vertices[still.tree.corners[:, b]]
    ends = np.stack([mesh.tails[edge], mesh.heads[edge]], axis=1)
    p, q = curve.vertices[ends].swapaxes(0, 1)
    chords, places = [], []
    for y, z in (corners[[0, 1]], corners[[1, 2]], corners[[2, 0]]):
        f = z - y + TINY**0.5  # segments are triangles with an edge of no length
        chord, s, _ = closest(EdgePairs(0.5 * ((p - y) + (q - z)), q - p, f))
        chords.append(chord)
        places.append(s)
    f, g = corners[1] - corners[0], corners[2] - corners[0]
    normal = np.cross(f, g)
    whole = np.maximum(dot(normal, normal), TINY)
    for end, place in ((p, -0.5), (q, 0.5)):  # above the inside of the triangle
        D = end - corners[0]
        r, t = (dot(np.cross(*each), normal) for each in ((D, g), (f, D)))
        inside = (r > 0.0) & (t > 0.0) & (r + t < whole)
        chord = normal * (dot(D, normal) / whole)[:, None]
        chords.append(np.where(inside[:, None], chord, np.inf))
        places.append(np.full(len(edge), place))
    which = np.argmin([dot(each, each) for each in chords], axis=0)
    chord, s = (np.stack(each)[which, np.arange(len(edge))] for each in (chords, places))
    d = np.sqrt(dot(chord, chord))
    unit = chord / np.where(d == 0.0, 1.0, d)[:, None]
    kept = d < within * radius[edge]
    edge, unit, s, need = edge[kept], unit[kept], s[kept], radius[edge[kept]]
    first = np.stack([0.5 - s, 0.5 + s, 0.0 * s, 0.0 * s], axis=1)[:, :, None] * unit[:, None] / need[:, None, None]
    four = np.concatenate([ends[kept], ends[kept]], axis=1)
    pairs = np.stack([edge, -1 - triangle[kept]], axis=1)
    return Clearances(d[kept] / need, first, four, lengths[edge] / need, pairs)
