"""A curve as seen in some frame: its diagram, the places of the passes on the curve, and triangles between its edges.

Any vertical motion that keeps the order at crossings is free of contact.  Heights z minimise Σ (Δz)²/ℓ over all edges
of lengths ℓ in the plane, while strands are at least a gap g apart where they cross, C z ≥ g.  With the matrix L of the
form, restricted to vertices that are free, the multipliers μ ≥ 0 minimise ½ |Cᵀμ|² in L⁻¹ less g·μ, the dual problem.

Points are inserted into triangulations one by one, and edges flipped until circumcircles are empty; then the edges that
cross a wall are flipped until it is an edge itself (S. W. Sloan, *Computers & Structures* 47, 1993).
"""

from collections import deque
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.optimize import Bounds, minimize
from scipy.sparse.linalg import splu

from ..base.messages import Message
from ..base.types import BoolArray, FloatArray, IntArray
from ..curve import Mesh
from ..knots.diagrams.diagram import ENDS, Diagram
from ..knots.diagrams.projection import PlaneCrossings, plane_crossings, project


class UnclearError(ArithmeticError):
    """The positions of strands are unclear, or there are too many to look at; ``reason`` says so in words."""

    def __init__(self, most: int = 0) -> None:
        self.reason = Message("strands touch, or nearly do: no view of the curve shows which one is in front")
        if most:
            self.reason = Message("in no view are there fewer than {most:,} crossings, which are too many", most=most)


@dataclass(frozen=True, eq=False)
class PlaneDrawing:
    """The diagram of a curve as seen along the third axis, with places where it is held among its passes."""

    mesh: Mesh
    points: FloatArray  # the vertices in the frame, shape (n, 3)
    crossings: PlaneCrossings  # of the edges, which are numbered by their tails here
    heights: FloatArray  # of both edges at each crossing; shape (2, k)
    diagram: Diagram
    at: list[float]  # where each pass is: the tail of its edge plus a fraction

    @classmethod
    def of(cls, mesh: Mesh, points: FloatArray, held: BoolArray) -> "PlaneDrawing":
        """The drawing of a curve with some vertices held; an UnclearError where rounding leaves it unclear."""
        clear = 1e-9  # of an edge, or of the size: anything nearer to the limit might be a rounding error
        crossings = plane_crossings(mesh, points, clear)
        if len(crossings.turn) >= (most := 5_000):
            raise UnclearError(most)
        found = project(mesh, points, crossings, np.flatnonzero(held), clear)
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


def level_heights(drawing: PlaneDrawing, held: BoolArray) -> FloatArray | None:
    """The most level heights of vertices, shape (n,), held ones unchanged; None if rounding leaves too small gaps."""
    mesh, points, found = drawing.mesh, drawing.points, drawing.crossings
    size = float(np.ptp(points[:, :2], axis=0).max())
    mean = float(points[held, 2].mean()) if held.any() else float(points[:, 2].mean())
    heights = points[:, 2] - mean
    # the form, with a thousandth of the size added to lengths; little stiffness draws all heights to their mean
    flat = np.linalg.norm(points[mesh.heads, :2] - points[mesh.tails, :2], axis=1) + 1e-3 * size
    difference = mesh.difference
    form = (difference.T @ sp.diags_array(1.0 / flat) @ difference + 0.05 / size * sp.eye_array(mesh.size)).tocsc()
    free = np.flatnonzero(~held)
    # the matrix C of height differences, upper less lower, at crossings; shape (k, n)
    count = len(found.turn)
    sign = np.where(drawing.heights[0] > drawing.heights[1], 1.0, -1.0)
    rows, columns, values = [], [], []
    for side, (edges, t) in zip((sign, -sign), zip(found.edges, found.at, strict=True), strict=True):
        for vertices, weight in ((mesh.tails[edges], 1.0 - t), (mesh.heads[edges], t)):
            rows.append(np.arange(count))
            columns.append(vertices)
            values.append(side * weight)
    entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))
    above = sp.csr_array(sp.coo_array(entries, shape=(count, mesh.size)))
    if count:
        above = above[np.flatnonzero(np.abs(above[:, free]).sum(axis=1) > 0)]
    solve = splu(form[free][:, free].tocsc()).solve
    level = np.where(held, heights, 0.0)
    level[free] = solve(-(form[free] @ level))
    gap = 0.03 * size
    wanted = gap - above @ level
    if len(wanted) and wanted.max() > 0:
        lower = above[:, free].tocsr()
        upper = lower.T.tocsr()

        def dual(multipliers: FloatArray) -> tuple[float, FloatArray]:
            slack = lower @ solve(upper @ multipliers) - wanted
            return float(0.5 * multipliers @ (slack - wanted)), slack

        bounded = {"maxiter": 150, "maxcor": 20, "ftol": 1e-7, "gtol": 0.0}
        least = minimize(dual, np.zeros(len(wanted)), jac=True, method="L-BFGS-B", bounds=Bounds(0.0), options=bounded)
        level[free] += solve(upper @ least.x)
    # rounding must leave a fifth of the gap, or of the gap before
    if (above @ level < 0.2 * np.minimum(gap, above @ heights)).any():
        return None
    return level + mean


class Triangles:
    """A triangulation of points, shape (n, 2), and the corners of a rectangle around all, with some segments as edges.

    Sides of lines are decided exactly.  Raises UnclearError if points are equal, or one is on a wall.
    """

    def __init__(self, points: FloatArray, walls: Iterable[tuple[int, int]]) -> None:
        low, high = points.min(axis=0), points.max(axis=0)
        pad = 0.15 * float((high - low).max())
        (x, y), (z, w) = low - pad, high + pad
        self.points = points = np.concatenate([points, [[x, y], [z, y], [z, w], [x, w]]])
        self._x: list[float]
        self._y: list[float]
        self._x, self._y = points.T.tolist()
        n = len(points)
        self._opposite: dict[tuple[int, int], int] = {}  # of directed edges, whose triangle is on their left
        self._put((n - 4, n - 3, n - 2), (n - 4, n - 2, n - 1))
        near = (n - 4, n - 3)
        for point in range(n - 4):
            a, b = near
            if self._side(a, b, point) < 0:
                a, b = b, a
            while True:
                c = self._opposite[a, b]
                if self._side(b, c, point) < 0:
                    a, b = c, b
                elif self._side(c, a, point) < 0:
                    a, b = a, c
                else:
                    break
            on = [(u, v) for u, v in ((a, b), (b, c), (c, a)) if self._side(u, v, point) == 0]
            if len(on) > 1:
                raise UnclearError
            if on:
                (u, v), w, z = on[0], self._opposite[on[0]], self._opposite[on[0][::-1]]
                del self._opposite[u, v], self._opposite[v, u]
                rim = [(v, w), (w, u), (u, z), (z, v)]
            else:
                rim = [(a, b), (b, c), (c, a)]
            self._put(*((u, v, point) for u, v in rim))
            while rim:
                u, v = rim.pop()
                beyond = self._opposite.get((v, u))
                if beyond is not None and self._in_circle(u, v, point, beyond) and self._convex(u, v):
                    self._flip(u, v)
                    rim += [(u, beyond), (beyond, v)]
            near = next((point, u) for u in (a, b, c) if (point, u) in self._opposite)
        around: list[set[int]] = [set() for _ in range(n)]
        for a, b in self._opposite:
            around[a].add(b)
        for a, b in walls:
            if b in around[a]:
                continue
            # the edges that cross the segment from a to b, each from its right to its left
            for u in around[a]:
                v = self._opposite.get((a, u), -1)
                if v >= 0 and self._side(a, b, u) < 0 < self._side(a, b, v) and self._side(u, v, b) < 0:
                    break
            else:
                raise UnclearError
            crossed = deque([(u, v)])
            while (w := self._opposite[v, u]) != b:
                side = self._side(a, b, w)
                if side == 0:
                    raise UnclearError
                u, v = (u, w) if side > 0 else (w, v)
                crossed.append((u, v))
            # these are flipped until a and b are joined by one
            while crossed:
                u, v = crossed.popleft()
                if not self._convex(u, v):
                    crossed.append((u, v))
                    continue
                p, q = self._flip(u, v)
                around[u].discard(v)
                around[v].discard(u)
                around[p].add(q)
                around[q].add(p)
                if not {a, b} & {p, q} and self._side(a, b, p) * self._side(a, b, q) < 0:
                    crossed.append((p, q))

    @property
    def corners(self) -> IntArray:
        """Points of each triangle, counterclockwise; shape (t, 3)."""
        return np.array([(a, b, c) for (a, b), c in self._opposite.items() if a < b and a < c])

    def _side(self, a: int, b: int, p: int) -> float:
        """Positive if p is on the left of the line from a to b, 0 if it is on the line: exactly decided."""
        x, y = self._x, self._y
        left, right = (x[b] - x[a]) * (y[p] - y[a]), (y[b] - y[a]) * (x[p] - x[a])
        if abs(left - right) > 4e-16 * (abs(left) + abs(right)):  # rounding leaves the sign
            return left - right
        ax, ay, bx, by, px, py = (Fraction(v) for k in (a, b, p) for v in (x[k], y[k]))
        exact = (bx - ax) * (py - ay) - (by - ay) * (px - ax)
        return float((exact > 0) - (exact < 0))

    def _in_circle(self, a: int, b: int, c: int, p: int) -> bool:
        """Whether p is inside the circle through a, b, c, up to rounding: only shapes depend on it."""
        rows = [(self._x[k] - self._x[p], self._y[k] - self._y[p]) for k in (a, b, c)]
        (ax, ay), (bx, by), (cx, cy) = rows
        aa, bb, cc = (u * u + v * v for u, v in rows)
        terms = aa * (bx * cy - by * cx), bb * (cx * ay - cy * ax), cc * (ax * by - ay * bx)
        return sum(terms) > 1e-12 * sum(map(abs, terms))

    def _put(self, *triangles: tuple[int, int, int]) -> None:
        for a, b, c in triangles:
            self._opposite[a, b], self._opposite[b, c], self._opposite[c, a] = c, a, b

    def _convex(self, u: int, v: int) -> bool:
        """Whether both triangles at an edge make a convex quadrilateral."""
        p, q = self._opposite[u, v], self._opposite[v, u]
        return self._side(p, q, u) * self._side(p, q, v) < 0

    def _flip(self, u: int, v: int) -> tuple[int, int]:
        p, q = self._opposite.pop((u, v)), self._opposite.pop((v, u))
        self._put((p, u, q), (q, v, p))
        return p, q
