"""Which vertices stay: pinned ones, and those that a stage shares with the next, which has another mesh.

A pin holds if a vertex has exactly its coordinates, the same vertex in all frames of a stage.

Vertices that both polygons have, with exactly the same coordinates and in the same cyclic order (in the same order, and
with the ends among them, where the polygons are open), span a third polygon. Each
other vertex has to lie on the edge of that polygon between its neighbours, up to the rounding of its coordinates, and
in the same order. Moving it exactly onto the edge must then be free of contact: this is checked like any other leg, in
rational numbers where necessary. So each of the two is isotopic to the common polygon, hence to the other.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

import numpy as np

from ..types import FloatArray, IntArray

_ROUNDING_UNITS = 16  # distance from the edge that is taken for rounding, in units of the last place

Point = Sequence[Fraction]


class DifferentCurveError(Exception):
    """Two polygons are not the same curve; the message says why."""


def common_vertices(first: FloatArray, second: FloatArray, closed: bool) -> tuple[list[int], list[int]]:
    """Indices in both polygons of the vertices they share; a DifferentCurveError if these are few or not in order."""
    places = {tuple(p): k for k, p in enumerate(second.tolist())}
    here = [k for k, p in enumerate(first.tolist()) if tuple(p) in places]
    there = [places[tuple(first[k].tolist())] for k in here]
    if len(there) < (3 if closed else 2):
        raise DifferentCurveError(f"only {len(there)} vertices are kept")
    ends = [here[0], here[-1], there[0], there[-1]]
    if not closed and ends != [0, len(first) - 1, 0, len(second) - 1]:
        raise DifferentCurveError("an end of an open component is not kept")
    turns = sum(b <= a for a, b in zip(there, there[1:] + there[:1], strict=True))
    if turns != 1:
        raise DifferentCurveError("the vertices that are kept are not in the same order")
    return here, there


def straightened(polygon: FloatArray, kept: Sequence[int], closed: bool = True) -> tuple[dict[int, Point], float]:
    """Move vertices of a polygon, shape (n, m), onto the edges between the vertices that are kept.

    Those kept are given by their indices, in ascending order; the ends of an open polygon are among them.  Returns the
    new places of the vertices that move, exact, and an upper bound for the change of any coordinate.  Raises a
    DifferentCurveError if one of them is further away than rounding, or if they are not in order.
    """
    moved: dict[int, Point] = {}
    largest = Fraction(0)
    n = len(polygon)
    for a, b in pairwise([*kept, kept[0] + n] if closed else kept):
        parameter = Fraction(0)
        for k in range(a + 1, b):
            place, at = _onto_edge(polygon[k % n], polygon[a % n], polygon[b % n])
            change = max(abs(x - Fraction(y)) for x, y in zip(place, polygon[k % n].tolist(), strict=True))
            if not (parameter < at < 1 and change <= Fraction(_allowed(polygon[[k % n, a % n, b % n]]))):
                raise DifferentCurveError(f"vertex {k % n} of the component is not on the edge between its neighbours")
            largest = max(largest, change)
            moved[k % n], parameter = place, at
    return moved, _rounded_up(largest)


def _rounded_up(x: Fraction) -> float:
    """A double that is not less, even for the smallest numbers, which would become 0."""
    return float(x) if Fraction(float(x)) >= x else math.nextafter(float(x), math.inf)


def _onto_edge(p: FloatArray, u: FloatArray, v: FloatArray) -> tuple[Point, Fraction]:
    """A point of the edge from u to v near p, and its parameter there, which is rounded to a double."""
    points = np.stack([p, u, v])
    points = np.ldexp(points, -1 - int(np.frexp(np.abs(points).max())[1]))  # so that differences don't overflow
    d, q = points[2] - points[1], points[0] - points[1]
    scale = float(np.abs(d).max()) or 1.0
    with np.errstate(over="ignore", invalid="ignore"):
        d, q = d / scale, q / scale
        parameter = float(d @ q / max(float(d @ d), np.finfo(np.float64).tiny))
    if not math.isfinite(parameter):
        raise DifferentCurveError("an edge with vertices on it is too short to tell where they are")
    at = Fraction(parameter)
    ends = [(Fraction(x), Fraction(y)) for x, y in zip(u.tolist(), v.tolist(), strict=True)]
    return [x + at * (y - x) for x, y in ends], at


def _allowed(points: FloatArray) -> float:
    return _ROUNDING_UNITS * float(np.spacing(np.abs(points).max()))


class LostPinError(Exception):
    """No vertex is at a pin, or none any more; the message says at which."""


@dataclass(frozen=True, eq=False)
class HeldVertices:
    """The vertices of one stage that must not move."""

    vertices: IntArray  # their indices, in the order of the pins; shape (k,)
    points: FloatArray  # the places of the pins, shape (k, m)

    @classmethod
    def among(cls, frame: FloatArray, points: FloatArray) -> "HeldVertices":
        """The vertices of a first frame, (n, m), at points, (k, m); a LostPinError if a point has none."""
        places = {tuple(vertex): k for k, vertex in enumerate(frame.tolist())}
        found = [places.get(tuple(point), -1) for point in points.tolist()]
        if -1 in found:
            raise LostPinError(f"no vertex is at pin {found.index(-1) + 1} (counted from 1)")
        return cls(np.array(found, dtype=np.intp), points)

    def check(self, frame: FloatArray) -> None:
        """Raise a LostPinError if one of them has moved in a later frame; if not, it stays on the way there."""
        moved = np.flatnonzero((frame[self.vertices] != self.points).any(axis=1)) if len(self.points) else self.vertices
        if moved.size:
            vertex = self.vertices[moved[0]] + 1
            raise LostPinError(f"vertex {vertex} leaves pin {moved[0] + 1} (counted from 1)")
