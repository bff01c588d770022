"""Integrals over a curve: its bending, and its writhe and average crossing number."""

from functools import lru_cache

import numpy as np

from ..base import CurveError, FloatArray, dot, frozen
from .curve import Curve


def bending(curve: Curve) -> float:
    """L ∫ κ² ds, L the total length: 4π² on a round circle, more on every other closed curve.

    Discretely ∫ κ² ds is the sum over the vertices of 4 tan²(θ/2)/ℓ, θ the angle that the polygon turns by and ℓ the
    mean length of the two edges: by the theorem of Fenchel no polygon has less than 4π² either.
    """
    return bending_and_derivative(curve)[0]


def bending_and_derivative(curve: Curve) -> tuple[float, FloatArray]:
    """`bending` and its derivative with respect to the vertices, shape (n, m)."""
    mesh, ell = curve.mesh, curve.edge_lengths
    before, after = mesh.incoming[mesh.inner], mesh.outgoing[mesh.inner]
    tau = curve.edge_vectors / ell[:, None]
    turn = tau[after] - tau[before]  # at each inner vertex, of length 2 sin(θ/2)
    sine, per_length = dot(turn, turn), 2.0 / (ell[after] + ell[before])
    cosine = np.maximum(4.0 - sine, 1e-20)  # (2 cos(θ/2))², which is 0 where edges double back
    bends, length = 4.0 * per_length * sine / cosine, curve.length
    by_turn = (32.0 * per_length / cosine**2)[:, None] * turn
    by_tangent = np.zeros_like(tau)
    by_tangent[after] += by_turn
    by_tangent[before] -= by_turn
    by_tangent -= dot(by_tangent, tau)[:, None] * tau
    by_length = np.zeros_like(ell)
    by_length[after] -= 0.5 * bends * per_length
    by_length[before] -= 0.5 * bends * per_length
    total = float(bends.sum())
    by_edge = length * (by_tangent / ell[:, None] + by_length[:, None] * tau) + total * tau
    return length * total, mesh.scatter(-by_edge, by_edge)


def writhe_and_crossings(curve: Curve, rows: int = 64) -> tuple[float, float]:
    """Writhe and average crossing number, crossings between components included; a CurveError unless it is in space.

    Both are averages over all directions of view, with signs and without.  Gauss's integral over a pair of edges is the
    area of the directions in which they are seen to cross, a spherical quadrilateral (Banchoff, *Indiana Univ. Math.
    J.* 25, 1976).  So many ``rows`` of pairs of edges are processed together.
    """
    if curve.dimension != 3:
        raise CurveError(f"the curve has dimension {curve.dimension}; only curves in space have a writhe")
    writhe = crossings = 0.0
    for first in range(0, curve.mesh.edges, rows):
        # signed areas with all later edges but neighbours: each of two triangles between the directions of chords (van
        # Oosterom and Strackee, *IEEE Trans. Biomed. Eng.* 30, 1983), whose triple products are equal
        mesh = curve.mesh
        tails, heads = curve.vertices[mesh.tails], curve.vertices[mesh.heads]
        i, j = slice(first, first + rows), slice(first, None)
        a, b, d, c = (end[None, j] - start[i, None] for start in (tails, heads) for end in (tails, heads))
        volume = dot(np.cross(curve.edge_vectors[None, j], curve.edge_vectors[i, None]), a)
        size_a, size_c = (np.sqrt(dot(x, x)) for x in (a, c))
        area = np.zeros_like(volume)
        for x in (b, d):
            across = (size_a * size_c + dot(a, c)) * np.sqrt(dot(x, x))
            area += 2.0 * np.arctan2(volume, across + dot(a, x) * size_c + dot(c, x) * size_a)
        one, other = np.arange(mesh.edges)[i, None], np.arange(mesh.edges)[None, j]
        counted = (other > one) & mesh.disjoint(one, other)
        areas = np.asarray(np.where(counted, area, 0.0))
        writhe += float(areas.sum())
        crossings += float(np.abs(areas).sum())
    return writhe / (2.0 * np.pi), crossings / (2.0 * np.pi)


@lru_cache(maxsize=2)
def bending_radii(curve: Curve) -> FloatArray:
    """At each vertex the radius of the circle that touches both edges, the shorter one at its middle; shape (n,).

    The last answers are kept: several terms and measures of a step ask the same.
    """
    ell, mesh = curve.edge_lengths, curve.mesh
    tau, before, after = curve.edge_vectors / ell[:, None], mesh.incoming, mesh.outgoing
    sine, cosine = (dot(d, d) for d in (tau[after] - tau[before], tau[after] + tau[before]))
    with np.errstate(divide="ignore", over="ignore"):  # straight on
        return frozen(0.5 * np.minimum(ell[before], ell[after]) * np.sqrt(cosine / sine))  # ½ min(ℓ, ℓ') / tan(θ/2)
