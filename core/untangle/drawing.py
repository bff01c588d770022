"""A curve as seen in some frame: its diagram, and the places of the passes on the curve."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..base import BoolArray, FloatArray, Message
from ..curve import Mesh
from ..knots.diagrams import Diagram
from ..knots.diagrams.diagram import ENDS
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
