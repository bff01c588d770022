"""The most level heights that keep what is above and what is below at every crossing.

Any vertical motion that keeps the order at crossings is free of contact.  Heights z minimise Σ (Δz)²/ℓ over all edges
of lengths ℓ in the plane, while strands are at least a gap g apart where they cross, C z ≥ g.  With the matrix L of the
form, restricted to vertices that are free, the multipliers μ ≥ 0 minimise ½ |Cᵀμ|² in L⁻¹ less g·μ, the dual problem.
"""

import numpy as np
import scipy.sparse as sp
from scipy.optimize import Bounds, minimize
from scipy.sparse.linalg import splu

from ..types import BoolArray, FloatArray
from .drawing import Drawing

_GAP = 0.03  # of the curve's size
_SHORT = 1e-3  # of the size, added to lengths
_LEVEL = 0.05  # of the stiffness of an edge as long as the curve is large: draws all heights to their mean
_DUAL = {"maxiter": 150, "maxcor": 20, "ftol": 1e-7, "gtol": 0.0}
_ENOUGH = 0.2  # of the gap, or of what it was: what rounding must leave


def combed(drawing: Drawing, held: BoolArray) -> FloatArray | None:
    """The heights of all vertices, shape (n,), those that are held as they are; None if rounding leaves too little."""
    mesh, points = drawing.mesh, drawing.points
    size = float(np.ptp(points[:, :2], axis=0).max())
    mean = float(points[held, 2].mean()) if held.any() else float(points[:, 2].mean())
    heights = points[:, 2] - mean
    flat = np.linalg.norm(points[mesh.heads, :2] - points[mesh.tails, :2], axis=1) + _SHORT * size
    difference = mesh.difference
    form = (difference.T @ sp.diags_array(1.0 / flat) @ difference + _LEVEL / size * sp.eye_array(mesh.size)).tocsc()
    free = np.flatnonzero(~held)
    above = _differences(drawing)
    kept = np.abs(above[:, free]).sum(axis=1) > 0 if above.shape[0] else np.zeros(0, dtype=bool)
    above = above[np.flatnonzero(kept)]
    solve = splu(form[free][:, free].tocsc()).solve
    level = np.where(held, heights, 0.0)
    level[free] = solve(-(form[free] @ level))
    wanted = _GAP * size - above @ level
    if len(wanted) and wanted.max() > 0:
        lower = above[:, free].tocsr()
        upper = lower.T.tocsr()

        def dual(multipliers: FloatArray) -> tuple[float, FloatArray]:
            slack = lower @ solve(upper @ multipliers) - wanted
            return float(0.5 * multipliers @ (slack - wanted)), slack

        least = minimize(dual, np.zeros(len(wanted)), jac=True, method="L-BFGS-B", bounds=Bounds(0.0), options=_DUAL)
        level[free] += solve(upper @ least.x)
    gaps, before = above @ level, above @ heights
    if (gaps < _ENOUGH * np.minimum(_GAP * size, before)).any():
        return None
    return level + mean


def _differences(drawing: Drawing) -> sp.csr_array:
    """The matrix C of height differences, upper less lower, at crossings; shape (k, n)."""
    mesh, found = drawing.mesh, drawing.crossings
    count = len(found.turn)
    sign = np.where(drawing.heights[0] > drawing.heights[1], 1.0, -1.0)
    rows, columns, values = [], [], []
    for side, (edges, t) in zip((sign, -sign), zip(found.edges, found.at, strict=True), strict=True):
        for vertices, weight in ((mesh.tails[edges], 1.0 - t), (mesh.heads[edges], t)):
            rows.append(np.arange(count))
            columns.append(vertices)
            values.append(side * weight)
    entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))
    return sp.csr_array(sp.coo_array(entries, shape=(count, mesh.size)))
