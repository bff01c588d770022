"""Orders in which things near each other in space come next to each other."""

import numpy as np

from ..types import FloatArray, IntArray
from .mesh import Mesh


def component_order(mesh: Mesh, points: FloatArray) -> IntArray:
    """Edges in curve order, the components sorted along a Z-curve through their centres; shape (edges,).

    ``points`` are the vertices, shape (m, n).
    """
    if len(mesh.component_sizes) < 3:
        return np.arange(mesh.edges)
    starts = mesh.offsets[:-1]
    centres = 0.5 * (np.minimum.reduceat(points, starts, axis=1) + np.maximum.reduceat(points, starts, axis=1))
    rank = np.empty(len(starts), dtype=np.intp)
    rank[z_order(centres)] = np.arange(len(starts))
    return np.argsort(rank[mesh.edge_component], kind="stable")


def z_order(points: FloatArray) -> IntArray:
    """Points along a Z-curve through a grid of 1024 cells in every direction; shapes (m, k) -> (k,)."""
    low, high = points.min(axis=1, keepdims=True), points.max(axis=1, keepdims=True)
    cells = ((points - low) / np.maximum(high - low, np.finfo(np.float64).tiny) * 1023).astype(np.int64)
    code = np.zeros(points.shape[1], dtype=np.int64)
    for bit in range(10):
        for axis, cell in enumerate(cells):
            code |= ((cell >> bit) & 1) << (len(cells) * bit + axis)
    return np.argsort(code, kind="stable")
