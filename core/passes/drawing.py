"""What is seen of a curve in some frame: its diagram, and where on the curve the diagram's passes are."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..curve import Mesh
from ..diagrams.diagram import ENDS, Diagram
from ..diagrams.projection import PlaneCrossings, plane_crossings, seen
from ..messages import Message
from ..types import BoolArray, FloatArray
from .triangles import UnclearError

MOST_CROSSINGS = 5_000
_CLEAR = 1e-9  # of an edge, or of the curve's size: what is nearer to the limit than that might be a rounding error


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
        Of its edges, which are numbered by their tails here.
    heights
        Of both edges at each crossing; shape (2, k).
    diagram
        With places where the curve is held among its passes.
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
        """The drawing of a curve some vertices of which are held; an UnclearError where rounding hides what it is."""
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
        """The edges of the diagram, and the nodes on each; circles without passes are edges of one number more."""
        for edge in range(len(self.at)):
            yield edge, self.stops(edge)[0]
        for part, passes in zip(self.mesh.slices, self.diagram.passes, strict=True):
            if not passes:
                yield len(self.at), [*range(part.start, part.stop), part.start]

    def wrapped(self, edge: int, place: float) -> float:
        """A place on an edge as the tail plus a fraction."""
        part = self.mesh.slices[self.diagram.component[edge]]
        return place - (part.stop - part.start if place >= part.stop else 0)
