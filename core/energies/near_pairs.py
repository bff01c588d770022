"""Which pairs of edges are so near that the midpoint rule misses what is between them."""

from functools import lru_cache

import numpy as np
from scipy.spatial import cKDTree

from ..curve import Curve
from ..curve.tiles import EdgePairIndices
from ..types import BoolArray, FloatArray, IntArray

NEAR = 1.0  # of q = |Δ|²/(ℓ_I + ℓ_J)², up to which only the exact energy of a pair counts,
FAR = 2.25  # and from where on only its midpoint energy does
MIN_INDEX_DISTANCE = 4


def replaced_pairs(curve: Curve) -> EdgePairIndices:
    """Those of the near pairs that count with their exact energy alone."""
    i, j = near_pairs(curve)
    replaced = is_replaced(curve, i, j)
    return i[replaced], j[replaced]


def is_replaced(curve: Curve, i: IntArray, j: IntArray) -> BoolArray:
    """Whether q ≤ 1; coordinate by coordinate, so that the answer for a pair does not depend on the others."""
    chord = (curve.midpoints[i] - curve.midpoints[j]).T
    return np.asarray(sum(c * c for c in chord) <= NEAR * (curve.edge_lengths[i] + curve.edge_lengths[j]) ** 2)


@lru_cache(maxsize=2)
def near_pairs(curve: Curve) -> tuple[IntArray, IntArray]:
    """Unordered pairs of edges with q < 9/4 that the barrier counts, as two index arrays, no longer edge first.

    A k-d tree per octave of edge lengths keeps the candidates few when lengths differ a lot: a near pair
    has |Δ| < 3 max(ℓ_I, ℓ_J), so each edge is searched within 3 lengths among edges no longer than its octave.
    The last answers are kept, because energy and barrier ask the same.
    """
    ell, midpoints = curve.edge_lengths, curve.midpoints
    octave = np.frexp(ell)[1]
    found: list[FloatArray] = []
    for level in np.unique(octave):
        long = np.flatnonzero(octave == level)
        short = np.flatnonzero(octave <= level)
        reach = 2.0 * np.sqrt(FAR) * float(np.max(ell[long]))
        tree = cKDTree(midpoints[long])
        near = tree.sparse_distance_matrix(cKDTree(midpoints[short]), reach, output_type="ndarray")
        found.append(np.stack([short[near["j"]], long[near["i"]], near["v"]]))
    table = np.concatenate(found, axis=1)
    i, j, distance = table[0].astype(np.intp), table[1].astype(np.intp), table[2]
    # within one octave every pair is found twice
    kept = (distance**2 < FAR * (ell[i] + ell[j]) ** 2) & ((octave[i] != octave[j]) | (i < j))
    i, j = i[kept], j[kept]
    kept = curve.mesh.index_distance(i, j) >= MIN_INDEX_DISTANCE
    i, j = i[kept], j[kept]
    swapped = ell[i] > ell[j]
    return np.where(swapped, j, i), np.where(swapped, i, j)
