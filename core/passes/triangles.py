"""Triangulations of points in the plane with some segments as edges; sides of lines are decided exactly.

Points are inserted one by one, and edges flipped until circumcircles are empty; then the edges that cross a wall
are flipped until it is an edge itself (S. W. Sloan, *Computers & Structures* 47, 1993).
"""

from collections import deque
from collections.abc import Iterable
from fractions import Fraction

import numpy as np

from ..messages import Message
from ..types import FloatArray, IntArray

_MARGIN = 0.15  # of the largest extent, around all points
_ROUNDING = 4e-16  # relative to the sum of both products: anything above it has the right sign


class UnclearError(ArithmeticError):
    """The positions of strands are unclear, or there are too many to look at; ``reason`` says so in words."""

    reason = Message("strands touch, or nearly do: no view of the curve shows which one is in front")


class Triangles:
    """A triangulation of points, shape (n, 2), followed by the corners of a rectangle around all of them.

    Raises UnclearError if points are equal, or one is on a wall.
    """

    def __init__(self, points: FloatArray, walls: Iterable[tuple[int, int]]) -> None:
        low, high = points.min(axis=0), points.max(axis=0)
        pad = _MARGIN * float((high - low).max())
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
            near = self._insert(point, near)
        around: list[set[int]] = [set() for _ in range(n)]
        for a, b in self._opposite:
            around[a].add(b)
        for a, b in walls:
            self._wall(a, b, around)

    @property
    def corners(self) -> IntArray:
        """Points of each triangle, counterclockwise; shape (t, 3)."""
        return np.array([(a, b, c) for (a, b), c in self._opposite.items() if a < b and a < c])

    def _side(self, a: int, b: int, p: int) -> float:
        """Positive if p is on the left of the line from a to b, 0 if it is on the line: exactly decided."""
        x, y = self._x, self._y
        left, right = (x[b] - x[a]) * (y[p] - y[a]), (y[b] - y[a]) * (x[p] - x[a])
        if abs(left - right) > _ROUNDING * (abs(left) + abs(right)):
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

    def _insert(self, p: int, near: tuple[int, int]) -> tuple[int, int]:
        a, b = near
        if self._side(a, b, p) < 0:
            a, b = b, a
        while True:
            c = self._opposite[a, b]
            if self._side(b, c, p) < 0:
                a, b = c, b
            elif self._side(c, a, p) < 0:
                a, b = a, c
            else:
                break
        on = [(u, v) for u, v in ((a, b), (b, c), (c, a)) if self._side(u, v, p) == 0]
        if len(on) > 1:
            raise UnclearError
        if on:
            (u, v), w, z = on[0], self._opposite[on[0]], self._opposite[on[0][::-1]]
            del self._opposite[u, v], self._opposite[v, u]
            rim = [(v, w), (w, u), (u, z), (z, v)]
        else:
            rim = [(a, b), (b, c), (c, a)]
        self._put(*((u, v, p) for u, v in rim))
        while rim:
            u, v = rim.pop()
            beyond = self._opposite.get((v, u))
            if beyond is not None and self._in_circle(u, v, p, beyond) and self._convex(u, v):
                self._flip(u, v)
                rim += [(u, beyond), (beyond, v)]
        return next((p, u) for u in (a, b, c) if (p, u) in self._opposite)

    def _convex(self, u: int, v: int) -> bool:
        """Whether both triangles at an edge make a convex quadrilateral."""
        p, q = self._opposite[u, v], self._opposite[v, u]
        return self._side(p, q, u) * self._side(p, q, v) < 0

    def _flip(self, u: int, v: int) -> tuple[int, int]:
        p, q = self._opposite.pop((u, v)), self._opposite.pop((v, u))
        self._put((p, u, q), (q, v, p))
        return p, q

    def _wall(self, a: int, b: int, around: list[set[int]]) -> None:
        """Flip edges until a and b are joined by one."""
        crossed = deque(self._across(a, b, around))
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

    def _across(self, a: int, b: int, around: list[set[int]]) -> list[tuple[int, int]]:
        """The edges that cross the segment from a to b, each from its right to its left."""
        if b in around[a]:
            return []
        for u in around[a]:
            v = self._opposite.get((a, u))
            if v is not None and self._side(a, b, u) < 0 < self._side(a, b, v) and self._side(u, v, b) < 0:
                break
        else:
            raise UnclearError
        crossed = [(u, v)]
        while (w := self._opposite[v, u]) != b:
            side = self._side(a, b, w)
            if side == 0:
                raise UnclearError
            u, v = (u, w) if side > 0 else (w, v)
            crossed.append((u, v))
        return crossed
