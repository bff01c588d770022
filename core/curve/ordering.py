"""An order of all edges in which components near each other in space come next to each other."""

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
    low, high = centres.min(axis=1, keepdims=True), centres.max(axis=1, keepdims=True)
    cells = ((centres - low) / np.maximum(high - low, np.finfo(np.float64).tiny) * 1023).astype(np.int64)
    code = np.zeros(len(starts), dtype=np.int64)
    for bit in range(10):
        for axis, cell in enumerate(cells):
            code |= ((cell >> bit) & 1) << (len(cells) * bit + axis)
    rank = np.empty(len(starts), dtype=np.intp)
    rank[np.argsort(code, kind="stable")] = np.arange(len(starts))
    return np.argsort(rank[mesh.edge_component], kind="stable")
