"""Integrals over clusters as differences of one running sum."""

import numpy as np

from ..curve import Curve
from ..types import FloatArray, IntArray


class RunningSum:
    """B: u ↦ z, z_k = Σ ℓ_I u_I over the first k edges in an order, with u at midpoints.

    Parameters
    ----------
    curve
        The curve, of n edges.
    order
        Edge at each position, shape (n,).
    """

    def __init__(self, curve: Curve, order: IntArray) -> None:
        mesh = curve.mesh
        self._tails, self._heads = order, mesh.heads[order]
        self._half = 0.5 * curve.edge_lengths[order, None]
        place = np.empty_like(order)
        place[order] = np.arange(len(order))
        self._place, self._place_before = place, place[mesh.previous]

    def apply(self, u: FloatArray) -> FloatArray:
        """B u; shapes (n, k) -> (n + 1, k)."""
        z = np.zeros((len(u) + 1, u.shape[1]))
        np.cumsum(self._half * (u[self._tails] + u[self._heads]), axis=0, out=z[1:])
        return z

    def apply_transpose(self, y: FloatArray) -> FloatArray:
        """Bᵀ y; shapes (n + 1, k) -> (n, k)."""
        back = self._half * np.cumsum(y[:0:-1], axis=0)[::-1]
        return np.asarray(back[self._place] + back[self._place_before])
