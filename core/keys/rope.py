"""Keyed polygons as ropes: 32-bit numbers, and points on edges, which are no corners but for rounding."""

import numpy as np

from ..base.types import FloatArray
from ..curve import Mesh

KEPT = 0.998  # of a rope's radius, once its points are rounded and those on edges left out; half of that is proved


def corners(mesh: Mesh, start: FloatArray, end: FloatArray, radius: float) -> tuple[Mesh, FloatArray, FloatArray]:
    """A straight motion without the points that lie on edges at both ends, up to rounding, or a bit of the radius.

    Of a row of them every eighth stays, so that what is rounded off adds up to no curve.  From and to (n, 3).
    """
    before, after = mesh.tails[mesh.incoming[mesh.inner]], mesh.heads[mesh.outgoing[mesh.inner]]
    straight, number = np.zeros(mesh.size, dtype=bool), np.arange(mesh.size)
    straight[mesh.inner] = True
    rounding = min(2e-7 * float(np.abs(start).max()), 0.02 * (1.0 - KEPT) * radius)
    for each in (start, end):
        chord, away = each[after] - each[before], each[mesh.inner] - each[before]
        off = np.linalg.norm(np.cross(chord, away), axis=1)
        straight[mesh.inner] &= off <= rounding * np.linalg.norm(chord, axis=1)
    straight &= (number - np.maximum.accumulate(np.where(straight, 0, number))) % 8 != 0
    counts = tuple(int((~straight[piece]).sum()) for piece in mesh.slices)
    if min(counts) < 3:
        return mesh, start, end
    return Mesh(counts, mesh.closed), start[~straight], end[~straight]
