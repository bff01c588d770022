"""Integrals over clusters as differences of one running sum."""

import numpy as np

from ..curve import Curve, Mesh
from ..types import FloatArray, IntArray


class RunningSum:
    """B: u ↦ z, z_k = Σ w_I (u(I↑) + s u(I↓)) over the first k edges in an order.

    Parameters
    ----------
    mesh
        Connectivity.
    order
        Edge at each position, shape (edges,).
    weights
        w, for each edge, shape (edges,).
    sign
        s.
    """

    def __init__(self, mesh: Mesh, order: IntArray, weights: FloatArray, sign: float) -> None:
        self._mesh, self._sign = mesh, sign
        self._tails, self._heads = mesh.tails[order], mesh.heads[order]
        self._weights = weights[order, None]
        self._place = np.empty_like(order)
        self._place[order] = np.arange(len(order))

    @classmethod
    def of_values(cls, curve: Curve, order: IntArray) -> "RunningSum":
        """∫ u, by the values at midpoints."""
        return cls(curve.mesh, order, 0.5 * curve.edge_lengths, 1.0)

    @classmethod
    def of_slopes(cls, curve: Curve, order: IntArray) -> "RunningSum":
        """∫ u'."""
        return cls(curve.mesh, order, np.ones(curve.mesh.edges), -1.0)

    def apply(self, u: FloatArray) -> FloatArray:
        """B u; shapes (n, k) -> (edges + 1, k)."""
        z = np.zeros((len(self._place) + 1, u.shape[1]))
        np.cumsum(self._weights * (u[self._heads] + self._sign * u[self._tails]), axis=0, out=z[1:])
        return z

    def apply_transpose(self, y: FloatArray) -> FloatArray:
        """Bᵀ y; shapes (edges + 1, k) -> (n, k)."""
        back = (self._weights * np.cumsum(y[:0:-1], axis=0)[::-1])[self._place]
        return self._mesh.scatter(self._sign * back, back)
