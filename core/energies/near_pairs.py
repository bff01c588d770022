"""Which pairs of edges are so near that the midpoint rule misses what is between them."""

import numpy as np
from scipy.spatial import cKDTree

from ..curve import Curve
from ..types import FloatArray, IntArray

FAR = 2.25  # of q = |Δ|²/(ℓ_I + ℓ_J)², from where pairs do not count
MIN_INDEX_DISTANCE = 4


def near_pairs(curve: Curve) -> tuple[IntArray, IntArray]:
    """Unordered pairs of edges with q < 9/4 that the barrier counts, as two index arrays, no longer edge first.

    A k-d tree per octave of edge lengths keeps the candidates few when lengths differ a lot: a near pair
    has |Δ| < 3 max(ℓ_I, ℓ_J), so each edge is searched within 3 lengths among edges no longer than its octave.
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
