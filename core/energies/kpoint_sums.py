"""The derivative of a k-point energy: from derivatives by the numbers of a pair of points to those by the vertices."""

import numpy as np

from ..curve import Curve
from ..curve.tiles import Tile
from ..types import FloatArray
from .arcs import ArcDerivative, Arcs
from .density import Density, Partials, PointPairs, PointSet


class KPointSums:
    """Derivatives of Σ ω_i ω_j ℓ_I ℓ_J F by tails, heads, unit tangents and lengths, over unordered pairs of edges."""

    def __init__(self, curve: Curve) -> None:
        self.arcs = Arcs(curve)
        self.tau = curve.edge_vectors / curve.edge_lengths[:, None]
        self._mesh = curve.mesh
        self._by_tail, self._by_head, self._by_tau = (np.zeros_like(curve.edge_vectors) for _ in range(3))
        self._by_length = np.zeros_like(curve.edge_lengths)
        self._by_arc = ArcDerivative(self.arcs)

    def add(self, tile: Tile, x: PointSet, y: PointSet, area: FloatArray, density: Density) -> float:
        """Add pairs of points with weights ``area``, 0 for pairs that do not count; returns their part of the sum."""
        pairs = PointPairs(x, y, self.arcs, tile)
        weighted = area * density.value(pairs)
        self._by_length[tile.rows] += weighted.sum(axis=1) / self.arcs.ell[tile.rows]
        self._by_length[tile.columns] += weighted.sum(axis=0) / self.arcs.ell[tile.columns]
        self._add_partials(tile, x, y, area, density.derivative(pairs))
        return float(weighted.sum())

    def _add_partials(self, tile: Tile, x: PointSet, y: PointSet, area: FloatArray, partials: Partials) -> None:
        """With d = x − y, ∂F/∂d is 2 F_{r²} d + F_a τ_x + F_b τ_y, ∂F/∂τ_x is F_a d + F_c τ_y, likewise ∂F/∂τ_y."""
        rows, columns = tile.rows, tile.columns
        tau_x, tau_y = self.tau[rows], self.tau[columns]
        force_x, force_y = _differences((2.0 * area) * partials.r2, x.x[rows], y.x[columns])  # Σ_J and Σ_I of ∂F/∂d
        if partials.a is not None:
            weights = area * partials.a
            self._by_tau[rows] += _differences(weights, x.x[rows], y.x[columns])[0]
            force_x += weights.sum(axis=1)[:, None] * tau_x
            force_y += weights.T @ tau_x
        if partials.b is not None:
            weights = area * partials.b
            self._by_tau[columns] += _differences(weights, x.x[rows], y.x[columns])[1]
            force_x += weights @ tau_y
            force_y += weights.sum(axis=0)[:, None] * tau_y
        if partials.c is not None:
            weights = area * partials.c
            self._by_tau[rows] += weights @ tau_y
            self._by_tau[columns] += weights.T @ tau_x
        if partials.rho is not None:
            self._by_arc.add(tile, x.t, y.t, area * partials.rho)
        self._add_force(rows, x.t, force_x)
        self._add_force(columns, y.t, -force_y)

    def _add_force(self, edges: slice, t: float, force: FloatArray) -> None:
        self._by_tail[edges] += (1.0 - t) * force
        self._by_head[edges] += t * force

    def at_vertices(self, arc_derivative: bool) -> FloatArray:
        """The derivative with respect to the vertices, shape (n, m), with or without the part of ϱ."""
        tau, by_length = self.tau, self._by_length
        if arc_derivative:
            by_length = by_length + self._by_arc.by_length()
        # ∂τ/∂e = (1 − τ τᵀ)/ℓ
        across = self._by_tau - np.einsum("ij,ij->i", self._by_tau, tau)[:, None] * tau
        by_edge = by_length[:, None] * tau + across / self.arcs.ell[:, None]
        return self._mesh.scatter(self._by_tail - by_edge, self._by_head + by_edge)


def _differences(weights: FloatArray, x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Σ_J w_IJ (x_I − y_J) and Σ_I w_IJ (x_I − y_J)."""
    by_row = weights.sum(axis=1)[:, None] * x - weights @ y
    by_column = weights.T @ x - weights.sum(axis=0)[:, None] * y
    return by_row, by_column
