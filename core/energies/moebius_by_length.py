"""Where on a curve its Möbius energy is: the energy of each edge's pairs, per unit of length."""

import numpy as np

from ..curve import Curve
from ..curve.tiles import pair_tiles
from ..types import FloatArray
from .moebius_pairs import Edges, Pairs


def moebius_by_length(curve: Curve) -> FloatArray:
    """Energy of each edge with all others per unit of length, (Σ_J W_IJ)/ℓ_I, shape (edges,); in 1/length.

    Times the lengths it sums up to the energy less what the components add, see `components`.
    """
    edges = Edges.of(curve)
    energy = np.zeros(curve.mesh.edges)
    for tile in pair_tiles(curve.mesh):
        g, p, q, s = Pairs.of(edges, tile)
        w = g * s - 2.0 * p * q
        energy[tile.rows] += w.sum(axis=1)
        energy[tile.columns] += w.sum(axis=0)
    return energy / curve.edge_lengths
