"""Diagrams of polygons in space: what is seen of them from some direction."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ...base import CurveError, FloatArray, IntArray, Message, check_time
from ...curve import NOWHERE, Curve, Mesh
from .diagram import ENDS, PIN, Diagram

NO_VIEW = Message("strands touch, or nearly do: no view of the curve shows which one is in front")


def views(curve: Curve, count: int, seed: int = 20217, clear: float = 1e-9) -> Iterator[Diagram]:
    """Diagrams of a closed polygon in space: first from where it looks flattest, then from random directions.

    Directions in which rounding might decide what crosses what are left out: where a crossing is nearer to another
    strand, or to the end of an edge, than ``clear``, a fraction of the curve's size or the edge's length.  Raises
    CurveError if there is no other direction.
    """
    rng = np.random.default_rng(seed)
    _, power = np.frexp(np.abs(curve.vertices).max())
    points = np.ldexp(curve.vertices, -power)  # where products of coordinates neither overflow nor vanish
    middle = points - points.mean(axis=0)
    for _, found in projections(curve.mesh, middle, frames(middle, count, rng), clear=clear):
        yield found.diagram


class UnclearError(CurveError):
    """No view shows which strand is in front, or all have too many crossings."""


def projections(
    mesh: Mesh,
    points: FloatArray,
    axes: Iterable[FloatArray],
    held: IntArray = NOWHERE,
    clear: float = 1e-9,
    most: float = np.inf,
) -> Iterator[tuple[FloatArray, "Projection"]]:
    """Yield what is seen of points, shape (n, 3), in some frames, with each, but where that is unclear.

    An UnclearError says if it is so in all of them, or there are ``most`` crossings or more.
    """
    none, reason = True, NO_VIEW
    for frame in axes:
        check_time()
        turned = points @ frame
        crossings = plane_crossings(mesh, turned, clear)
        if len(crossings.turn) >= most:
            reason = Message("in no view are there fewer than {most:,} crossings, which are too many", most=most)
        elif (found := project(mesh, turned, crossings, held, clear)) is None:
            reason = NO_VIEW
        else:
            none = False
            yield frame, found
    if none:
        raise UnclearError(reason)


def frames(middle: FloatArray, count: int, rng: np.random.Generator) -> list[FloatArray]:
    """Rotations to the axes of views: from where points, (n, 3) around 0, are flattest, turned a little; then random.

    It is turned by about 0.02 radians, so that nothing special is seen.
    """
    flattest = np.linalg.svd(middle, full_matrices=False)[2] + 0.02 * rng.normal(size=(3, 3))
    return [rotation(each) for each in (flattest, *rng.normal(size=(count - 1, 3, 3)))]


def rotation(frame: FloatArray) -> FloatArray:
    """The rotation to axes near the rows of a matrix."""
    q, r = np.linalg.qr(frame.T)
    q = q * np.sign(np.diag(r))
    return np.asarray(q * [1.0, 1.0, np.sign(np.linalg.det(q))])


class PlaneCrossings(NamedTuple):
    """Pairs of edges without a common vertex whose inner points cross in the plane."""

    edges: IntArray  # ascending in each pair; shape (2, k)
    at: FloatArray  # where on them, as fractions of their lengths; shape (2, k)
    turn: FloatArray  # cross product of their vectors, positive if the second crosses from right to left; shape (k,)


@dataclass(frozen=True, eq=False)
class Projection:
    """What is seen of polygons along the third axis: their diagram, with held places among its passes."""

    mesh: Mesh
    points: FloatArray  # the vertices, shape (n, 3)
    crossings: PlaneCrossings  # of the edges, which are numbered by their tails here
    heights: FloatArray  # of both edges at each crossing; shape (2, k)
    diagram: Diagram
    at: list[float]  # where each pass is: the tail of its edge plus a fraction

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


def project(mesh: Mesh, points: FloatArray, found: PlaneCrossings, held: IntArray, clear: float) -> Projection | None:
    """The diagram of points, shape (n, 3), with these crossings and held vertices; None if it is unclear."""
    edges, at = found.edges, found.at
    heights = points[mesh.tails[edges], 2] * (1.0 - at) + points[mesh.heads[edges], 2] * at
    apart = np.abs(heights[0] - heights[1]) / np.ptp(points, axis=0).max()
    if min(at.min(initial=1.0), 1.0 - at.max(initial=0.0), apart.min(initial=1.0)) < clear:
        return None
    above = heights[0] > heights[1]
    signs = np.sign(np.where(above, found.turn, -found.turn)).astype(int).tolist()
    held = np.setdiff1d(held, mesh.ends[:, 1])
    along = np.concatenate([(mesh.tails[edges] + at).ravel(), held])
    crossing = np.concatenate([np.tile(np.arange(len(signs)), 2), np.full(len(held), PIN[0])])
    upper = np.concatenate([above, ~above, ~np.isin(held, mesh.ends[:, 0])])  # as in PIN and ENDS
    order = np.argsort(along, kind="stable")
    parts = (order[a:b] for a, b in pairwise(np.searchsorted(along[order], mesh.offsets).tolist()))
    passes = (tuple(zip(crossing[part].tolist(), upper[part].tolist(), strict=True)) for part in parts)
    diagram = Diagram(tuple(passes), tuple(signs))
    return Projection(mesh, points, found, heights, diagram, along[order].tolist()) if diagram.is_planar else None


def plane_crossings(mesh: Mesh, points: FloatArray, beyond: float = 0.0) -> PlaneCrossings:
    """Find all crossings of polygons; of ``points``, shape (n, 2 or more), only x and y are looked at.

    Edges are taken to be longer by a part ``beyond`` of their lengths at both ends.
    """
    start, end = points[mesh.tails, :2], points[mesh.heads, :2]
    edge = end - start
    longer = np.abs(beyond * edge)
    low, high = (np.minimum(start, end) - longer).T.copy(), (np.maximum(start, end) + longer).T.copy()
    pairs = [(np.empty(0, dtype=np.intp),) * 2]
    for first in range(0, mesh.edges, 64):  # edges near each other: only what meets the box around them is looked at
        a, b = low[:, first : first + 64], high[:, first : first + 64]
        near = np.arange(first + 1, mesh.edges)
        for bottom, top, p, q in zip(low, high, a, b, strict=True):
            near = near[(bottom[near] <= q.max()) & (top[near] >= p.min())]
        i, j = np.nonzero(((low[:, None, near] <= b[:, :, None]) & (high[:, None, near] >= a[:, :, None])).all(axis=0))
        pairs.append((first + i, near[j]))
    i, j = map(np.concatenate, zip(*pairs, strict=True))
    later = (j > i) & (mesh.heads[i] != mesh.tails[j]) & (mesh.heads[j] != mesh.tails[i])
    i, j = i[later], j[later]
    apart, turn = start[j] - start[i], _cross(edge[i], edge[j])
    with np.errstate(divide="ignore", invalid="ignore"):
        s, t = _cross(apart, edge[j]) / turn, _cross(apart, edge[i]) / turn
    found = np.flatnonzero((np.minimum(s, t) > -beyond) & (np.maximum(s, t) < 1.0 + beyond))
    return PlaneCrossings(np.stack([i[found], j[found]]), np.stack([s[found], t[found]]), turn[found])


def _cross(u: FloatArray, v: FloatArray) -> FloatArray:
    return np.asarray(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
