"""The bending of polygons: how strongly a curve turns, whatever its size."""

import numpy as np

from ..types import FloatArray
from .curve import Curve

TINY = 1e-20  # against division by 0 where edges double back


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
    sine, per_length = np.einsum("ij,ij->i", turn, turn), 2.0 / (ell[after] + ell[before])
    cosine = np.maximum(4.0 - sine, TINY)  # (2 cos(θ/2))²
    bends, length = 4.0 * per_length * sine / cosine, curve.length
    by_turn = (32.0 * per_length / cosine**2)[:, None] * turn
    by_tangent = np.zeros_like(tau)
    by_tangent[after] += by_turn
    by_tangent[before] -= by_turn
    by_tangent -= np.einsum("ij,ij->i", by_tangent, tau)[:, None] * tau
    by_length = np.zeros_like(ell)
    by_length[after] -= 0.5 * bends * per_length
    by_length[before] -= 0.5 * bends * per_length
    total = float(bends.sum())
    by_edge = length * (by_tangent / ell[:, None] + by_length[:, None] * tau) + total * tau
    return length * total, mesh.scatter(-by_edge, by_edge)
