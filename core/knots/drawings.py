"""Knots from drawings: closed curves in the plane whose crossings are found and lifted into space.

The lifted curve lies straight above the drawing, so it meets itself nowhere but where the drawing crosses, and there
the two strands have different heights: it is embedded, and has the drawn crossings, by construction.
"""

from collections.abc import Collection
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
from scipy.spatial import cKDTree

from ..base import BoolArray, CurveError, FloatArray, Place, checked
from ..collision import check_embedded
from ..curve import Curve, arc_distance_of_pairs, arc_lengths, check_closed, subdivide
from .diagrams.projection import plane_crossings


@dataclass(frozen=True, eq=False)
class Drawing:
    """Closed curves in the plane that cross themselves and each other clearly, two strands at a time, c times."""

    curve: Curve
    #: first and second edge at each crossing, in the order in which these are reached, each by its tail, with the
    #: fraction of the edge, as one number; shape (c, 2)
    passes: FloatArray
    first_over: BoolArray  #: whether the first is the upper one: from `of`, over and under alternate; shape (c,)

    @cached_property
    def crossings(self) -> FloatArray:
        """The places of the crossings; shape (c, 2)."""
        tail, cycle = self.passes[:, 0].astype(np.intp), self.curve.mesh.cycle
        fraction = (self.passes[:, 0] - tail)[:, None]
        return np.asarray(self.curve.vertices[tail] * (1.0 - fraction) + self.curve.vertices[cycle[tail]] * fraction)

    @classmethod
    @checked
    def of(cls, curve: Curve) -> "Drawing":
        """Find the crossings of closed plane polygons; CurveError says where strands touch, or more than two meet."""
        if curve.dimension != 2:
            raise CurveError(f"the drawing has dimension {curve.dimension}; it must lie in the plane")
        check_closed(curve, "drawings")
        if len(curve) > 20_000:  # seconds to compare all edges
            raise CurveError(f"the drawing has {len(curve)} points; at most 20000 are allowed")
        if not _size(curve):
            raise CurveError("all points of the drawing are the same; draw a closed curve")
        # points are moved a little so that no strand runs exactly through a vertex of another
        noise = np.random.default_rng(20213).uniform(-1.0, 1.0, curve.vertices.shape)
        generic = curve.with_vertices(curve.vertices + 1e-9 * _size(curve) * noise)
        found = plane_crossings(generic.mesh, generic.vertices)
        passes = (found.edges + found.at).T
        passes = passes[np.argsort(passes[:, 0])]
        edge = passes[:, 0].astype(np.intp)
        points = generic.vertices[edge] + (passes[:, 0] - edge)[:, None] * generic.edge_vectors[edge]
        # refused are crossings too near each other, and strands as near that do not cross within 20 times that distance
        clear = 1e-3 * _size(generic)
        tree = cKDTree(points) if len(points) else None
        if tree is not None and (pairs := tree.query_pairs(clear, output_type="ndarray")).size:
            raise _unclear(points[pairs[0, 0]], int(edge[pairs[0, 0]]))
        pieces = np.ceil(generic.edge_lengths / clear).astype(np.intp).clip(1)
        dense, source = subdivide(generic, pieces), np.repeat(np.arange(len(generic)), pieces)
        i, j = cKDTree(dense.vertices).query_pairs(clear, output_type="ndarray").T
        apart = arc_distance_of_pairs(dense, i, j) > 20.0 * clear
        i = i[apart]
        if tree is not None and i.size:
            i = i[tree.query(dense.vertices[i])[0] > 20.0 * clear]
        if i.size:
            raise _unclear(dense.vertices[i[0]], int(source[i[0]]))
        # The plane is coloured like a chessboard; a strand goes over where it has come with a white field on its left.
        # At a crossing this holds for one strand of the two, and along the curve for every other pass, in links too.
        upper, at, heads = np.zeros(passes.shape, dtype=bool), passes.ravel(), generic.mesh.heads
        for part in generic.mesh.slices:
            mine = np.flatnonzero((at >= part.start) & (at < part.stop))
            if not mine.size:
                continue
            mine = mine[np.argsort(at[mine])]
            start = part.start + 0.5 * min(float(at[mine[0]]) - part.start, 1.0)
            # number of times that a ray from there to its left meets the curve again
            tail = int(start)
            vector = generic.edge_vectors[tail]
            around = generic.vertices - (generic.vertices[tail] + (start - tail) * vector)
            along, left = around @ vector, around @ np.array([-vector[1], vector[0]])
            meets = (along > 0) != (along[heads] > 0)
            meets[tail] = False
            fraction = along[meets] / (along[meets] - along[heads][meets])
            fields = np.count_nonzero(left[meets] + fraction * (left[heads][meets] - left[meets]) > 0)
            upper.ravel()[mine] = (np.arange(len(mine)) + fields) % 2 == 0
        # the first crossing's first pass is an upper one
        return cls(generic, passes, np.asarray(upper[:, 0] == upper[:1, 0]))

    @classmethod
    @checked
    def seen(cls, curve: Curve) -> "Drawing":
        """Find the crossings of closed polygons in space as seen from +z, where higher strands pass over."""
        drawing = cls.of(Curve(curve.vertices[:, :2], curve.mesh))
        edge = drawing.passes.astype(np.intp)
        heights = curve.vertices[edge, 2] + (drawing.passes - edge) * curve.edge_vectors[edge, 2]
        return replace(drawing, first_over=heights[:, 0] > heights[:, 1])

    def lifted(self, changed: Collection[int] = ()) -> Curve:
        """Lift strands over and under as ``first_over`` says, but for crossings ``changed``, from 1; or CurveError."""
        count = len(self.crossings)
        for number in changed:
            if not 1 <= number <= count:
                raise CurveError(f"there is no crossing {number}; the drawing has {count}, counted from 1")
        over = self.first_over.copy()
        over[[number - 1 for number in changed]] ^= True
        heights = np.full(count, 0.08 * _size(self.curve))  # of the drawing's size
        if count > 1:
            nearest_crossing = cKDTree(self.crossings).query(self.crossings, k=2)[0][:, 1]
            heights = np.minimum(heights, 0.3 * nearest_crossing)
        heights = np.where(over, heights, -heights)
        at, lift = self.passes.ravel(), np.stack([heights, -heights], axis=1).ravel()
        order = np.argsort(at)
        parts, nearest = [], 1e-4 * _size(self.curve)
        for part in self.curve.mesh.slices:
            mine = order[(at[order] >= part.start) & (at[order] < part.stop)]
            points, own = self.curve.vertices[part], lift[mine]
            closed = np.concatenate([points, points[:1]])
            arc = arc_lengths(closed)
            marks = np.interp(at[mine] - part.start, np.arange(len(closed)), arc)
            places = _with(marks, arc[:-1], nearest, arc[-1])  # vertices give way to crossings that are nearer
            for a, b in pairwise([*marks, marks[0] + arc[-1]] if len(marks) else [0.0, arc[-1]]):
                ramp = np.linspace(a, b, 10, endpoint=False)[1:]
                places = _with(places, ramp % arc[-1], 0.5 * (ramp[1] - ramp[0]), arc[-1])
            height = np.zeros(len(places))
            if len(marks):  # smooth ramps between crossings
                ends = np.concatenate([marks[-1:] - arc[-1], marks, marks[:1] + arc[-1]])
                k = np.searchsorted(ends, places, side="right") - 1
                u = (places - ends[k]) / (ends[k + 1] - ends[k])
                low, high = np.take(own, k - 1, mode="wrap"), np.take(own, k, mode="wrap")
                height = low + (high - low) * u * u * (3.0 - 2.0 * u)
            parts.append(np.column_stack([*(np.interp(places, arc, x) for x in closed.T), height]))
        curve = Curve.from_components(parts)
        check_embedded(curve)
        return curve


def _with(places: FloatArray, more: FloatArray, nearest: float, length: float) -> FloatArray:
    """Add places on a closed curve, except those that are near others; sorted."""
    if not len(places):
        return more
    gaps = np.abs(more[:, None] - places[None, :])
    return np.sort(np.concatenate([places, more[np.minimum(gaps, length - gaps).min(axis=1) > nearest]]))


def _size(curve: Curve) -> float:
    return float(np.ptp(curve.vertices, axis=0).max())


def _unclear(point: FloatArray, vertex: int) -> CurveError:
    place = ", ".join(f"{x:.4g}" for x in point)
    return CurveError(
        f"near ({place}) strands touch without crossing clearly, or more than two meet; move one of them away",
        Place((vertex,), tuple(map(float, point))),
    )
