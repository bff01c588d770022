"""The barrier that a one-point rule lacks: near pairs of edges get their exact energy instead.

    B = Σ χ(q_IJ) (W_exact − W_mid),   q = |Δ|²/(ℓ_I + ℓ_J)²,

over ordered pairs of different components or at index distance 4 or more.  χ is a C² cutoff, 1 up to
q = 1 and 0 from q = 9/4, so B is one C² function of the vertices and vanishes on well-resolved curves.
"""

import numpy as np
from scipy.spatial import cKDTree

from ..curve import Curve
from ..types import FloatArray, IntArray
from .segments import EdgePairs, exact_contributions

NEAR, FAR = 1.0, 2.25  # of q, where the cutoff leaves 1 and reaches 0
MIN_INDEX_DISTANCE = 4


class Barrier:
    """B, the difference between exact and midpoint energy over near pairs of edges."""

    name = "barrier"
    description = "exact minus midpoint energy of near pairs of edges"

    def value(self, curve: Curve) -> float:
        """B; 0 when strands are further apart than edges are long."""
        return self.value_and_derivative(curve)[0]

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        """B and its derivative with respect to the vertices, shape (n, m)."""
        derivative = np.zeros_like(curve.vertices)
        i, j = near_pairs(curve)
        if not len(i):
            return 0.0, derivative
        mesh = curve.mesh
        corners = (mesh.tails[i], mesh.heads[i], mesh.tails[j], mesh.heads[j])
        pairs = EdgePairs(*(curve.vertices[c] for c in corners))
        exact, by_exact = exact_contributions(pairs)
        midpoint, by_midpoint = midpoint_contributions(pairs)
        q, by_q = _closeness(pairs)
        chi, chi_slope = _cutoff(q)
        excess = exact - midpoint
        for corner, de, dm, dq in zip(corners, by_exact, by_midpoint, by_q, strict=True):
            # unordered pairs are listed, the sum is over ordered ones
            np.add.at(derivative, corner, 2.0 * (chi[:, None] * (de - dm) + (chi_slope * excess)[:, None] * dq))
        return 2.0 * float(chi @ excess), derivative


def near_pairs(curve: Curve) -> tuple[IntArray, IntArray]:
    """Unordered pairs of edges with q < 9/4 that the barrier counts, as two index arrays.

    A k-d tree per octave of edge lengths keeps the candidates few when lengths differ a lot: a near pair
    has |Δ| < 3 max(ℓ_I, ℓ_J), so each edge is searched within 3 lengths among edges no longer than its octave.
    """
    ell, midpoints = curve.edge_lengths, curve.midpoints
    octave = np.frexp(ell)[1]
    found: list[FloatArray] = []
    for level in np.unique(octave):
        long = np.flatnonzero(octave == level)
        short = np.flatnonzero(octave <= level)
        reach = 2.0 * np.sqrt(FAR) * float(ell[long].max())
        tree = cKDTree(midpoints[long])
        near = tree.sparse_distance_matrix(cKDTree(midpoints[short]), reach, output_type="ndarray")
        found.append(np.stack([long[near["i"]], short[near["j"]], near["v"]]))
    table = np.concatenate(found, axis=1)
    i, j, distance = table[0].astype(np.intp), table[1].astype(np.intp), table[2]
    # within one octave every pair is found twice
    kept = (distance**2 < FAR * (ell[i] + ell[j]) ** 2) & ((octave[i] != octave[j]) | (i < j))
    i, j = i[kept], j[kept]
    kept = curve.mesh.index_distance(i, j) >= MIN_INDEX_DISTANCE
    return i[kept], j[kept]


def midpoint_contributions(pairs: EdgePairs) -> tuple[FloatArray, EdgePairs]:
    """W_mid of each pair, shape (k,), and its derivative with respect to the end points."""
    x0, x1, y0, y1 = pairs
    e, f, delta = x1 - x0, y1 - y0, 0.5 * (x0 + x1) - 0.5 * (y0 + y1)
    le, lf = np.linalg.norm(e, axis=1), np.linalg.norm(f, axis=1)
    s = 1.0 / _dot(delta, delta)
    p, q = _dot(delta, e) * s, _dot(delta, f) * s
    g = le * lf + _dot(e, f)
    by_e = s[:, None] * (f + (lf / le)[:, None] * e - 2.0 * q[:, None] * delta)
    by_f = s[:, None] * (e + (le / lf)[:, None] * f - 2.0 * p[:, None] * delta)
    a = 8.0 * p * q * s - 2.0 * g * s * s
    by_delta = a[:, None] * delta - 2.0 * s[:, None] * (q[:, None] * e + p[:, None] * f)
    half = 0.5 * by_delta
    return g * s - 2.0 * p * q, EdgePairs(half - by_e, half + by_e, -half - by_f, -half + by_f)


def _closeness(pairs: EdgePairs) -> tuple[FloatArray, EdgePairs]:
    """q = |Δ|²/(ℓ_I + ℓ_J)² of each pair and its derivative with respect to the end points."""
    x0, x1, y0, y1 = pairs
    e, f, delta = x1 - x0, y1 - y0, 0.5 * (x0 + x1) - 0.5 * (y0 + y1)
    le, lf = np.linalg.norm(e, axis=1), np.linalg.norm(f, axis=1)
    total = le + lf
    q = _dot(delta, delta) / total**2
    by_e = (-2.0 * q / (total * le))[:, None] * e
    by_f = (-2.0 * q / (total * lf))[:, None] * f
    half = (1.0 / total**2)[:, None] * delta
    return q, EdgePairs(half - by_e, half + by_e, -half - by_f, -half + by_f)


def _cutoff(q: FloatArray) -> tuple[FloatArray, FloatArray]:
    """χ(q), the quintic smoothstep from 1 (q ≤ 1) to 0 (q ≥ 9/4), and its slope."""
    x = np.clip((FAR - q) / (FAR - NEAR), 0.0, 1.0)
    return x**3 * (10.0 - 15.0 * x + 6.0 * x * x), -30.0 * (x * (1.0 - x)) ** 2 / (FAR - NEAR)


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.einsum("ij,ij->i", a, b)
