"""A curve as seen in some frame: its diagram, the places of the passes on the curve, and their most level heights.

Any vertical motion that keeps the order at crossings is free of contact.  Heights z minimise Σ (Δz)²/ℓ over all edges
of lengths ℓ in the plane, while strands are at least a gap g apart where they cross, C z ≥ g.  With the matrix L of the
form, restricted to vertices that are free, the multipliers μ ≥ 0 minimise ½ |Cᵀμ|² in L⁻¹ less g·μ, the dual problem.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.optimize import Bounds, minimize
from scipy.sparse.linalg import splu

from ..curve import Mesh
from ..diagrams.diagram import ENDS, Diagram
from ..diagrams.projection import PlaneCrossings, plane_crossings, seen
from ..messages import Message
from ..types import BoolArray, FloatArray
from .triangles import UnclearError

MOST_CROSSINGS = 5_000
_CLEAR = 1e-9  # of an edge, or of the curve's size: anything nearer to the limit might be a rounding error
_GAP = 0.03  # of the curve's size
_SHORT = 1e-3  # of the size, added to lengths
_LEVEL = 0.05  # of the stiffness of an edge as long as the curve is large: draws all heights to their mean
_DUAL = {"maxiter": 150, "maxcor": 20, "ftol": 1e-7, "gtol": 0.0}
_ENOUGH = 0.2  # of the gap, or of the gap before: what rounding must leave


class CrowdedError(UnclearError):
    """There are too many crossings."""

    reason = Message("in no view are there fewer than {most:,} crossings, which are too many", most=MOST_CROSSINGS)


@dataclass(frozen=True, eq=False)
class Drawing:
    """The diagram of a curve as seen along the third axis.

    Attributes
    ----------
    mesh, points
        The curve in the frame, shape (n, 3).
    crossings
        The crossings of its edges, which are numbered by their tails here.
    heights
        The heights of both edges at each crossing; shape (2, k).
    diagram
        The diagram, with places where the curve is held among its passes.
    at
        Where each pass is: the tail of its edge plus a fraction.
    """

    mesh: Mesh
    points: FloatArray
    crossings: PlaneCrossings
    heights: FloatArray
    diagram: Diagram
    at: list[float]

    @classmethod
    def of(cls, mesh: Mesh, points: FloatArray, held: BoolArray) -> "Drawing":
        """The drawing of a curve with some vertices held; an UnclearError where rounding leaves it unclear."""
        crossings = plane_crossings(mesh, points, _CLEAR)
        if len(crossings.turn) >= MOST_CROSSINGS:
            raise CrowdedError
        found = seen(mesh, points, crossings, np.flatnonzero(held), _CLEAR)
        if found is None:
            raise UnclearError
        return cls(mesh, points, *found)

    @cached_property
    def nodes(self) -> FloatArray:
        """The vertices in the plane, and after them the crossings; shape (n + k, 2)."""
        crossings = self.mesh.tails[self.crossings.edges[0]] + self.crossings.at[0]
        return np.concatenate([self.points[:, :2], self.placed(crossings)])

    def placed(self, at: FloatArray) -> FloatArray:
        """Points of the plane at tails plus fractions."""
        tails = np.floor(at).astype(np.intp)
        t = (at - tails)[:, None]
        return np.asarray(self.points[tails, :2] * (1.0 - t) + self.points[self.mesh.cycle[tails], :2] * t)

    def stops(self, edge: int) -> tuple[list[int], list[float]]:
        """The nodes on an edge of the diagram, its ends included, and where on the component they are, ascending."""
        diagram, n = self.diagram, self.mesh.size
        part = self.mesh.slices[diagram.component[edge]]
        size, after = part.stop - part.start, diagram.next[edge]
        begin, end = self.at[edge], self.at[after]
        if diagram.sequence[after] == ENDS:
            end = part.stop - 1.0
        elif end <= begin:
            end += size
        inner = range(int(np.floor(begin)) + 1, int(np.ceil(end)))
        first, last = (
            n + crossing if crossing >= 0 else part.start + (int(place) - part.start) % size
            for (crossing, _), place in ((diagram.sequence[edge], begin), (diagram.sequence[after], end))
        )
        wrap = [part.start + (k - part.start) % size for k in inner]
        return [first, *wrap, last], [begin, *map(float, inner), end]

    def chains(self) -> Iterator[tuple[int, list[int]]]:
        """The edges of the diagram, and the nodes on each; circles without passes take the next number."""
        for edge in range(len(self.at)):
            yield edge, self.stops(edge)[0]
        for part, passes in zip(self.mesh.slices, self.diagram.passes, strict=True):
            if not passes:
                yield len(self.at), [*range(part.start, part.stop), part.start]

    def wrapped(self, edge: int, place: float) -> float:
        """A place on an edge as the tail plus a fraction."""
        part = self.mesh.slices[self.diagram.component[edge]]
        return place - (part.stop - part.start if place >= part.stop else 0)


def combed(drawing: Drawing, held: BoolArray) -> FloatArray | None:
    """The heights of all vertices, shape (n,), with held ones unchanged; None if rounding leaves too small gaps."""
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
