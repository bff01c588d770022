"""A rope on its way to be pulled tight: all of its motions, and all changes of its mesh, are proved those of a rope.

Where vertices double, every edge is halved, which leaves the curve as it is, and all vertices move on by half an edge,
which cuts corners.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from ..base.types import FloatArray
from ..collision import is_rope, thickness
from ..curve import Curve
from ..curve.refine import onto_chords, subdivide
from ..descent.task import check_refined
from ..driver import Relaxation
from ..io.trajectory import Iterate
from ..solve.saddle.tangent_space import factorised
from .interior_point import FALL, InteriorPoint, outward
from .splines import cubic_splines

COARSE = 100  # vertices that find the shape, up to twice as many
PER_CONTROL = 4  # vertices on splines
GAP = 1e-6  # of forces times clearances, relative to the length, at rest


class PulledRope:
    """The rope on its way: the last iterate, and the interior point on its mesh, in radii around a centre."""

    def __init__(self, last: Iterate, unit: float) -> None:
        # 1e-6 of the radius less, which motions are proved with: between their ends strands come a little nearer
        radius = (unit * (1.0 - 1e-6),) * len(last.curve.mesh.component_sizes)
        self.last = replace(last, pins=(), radius=radius, energy=last.curve.length / unit)
        self.unit, self.center, self.lengths = unit, last.curve.vertices.mean(axis=0), last.curve.component_lengths
        self.point: InteriorPoint | None = None
        self.per = 1  # vertices for each control point of splines, if they are on splines

    @property
    def curve(self) -> Curve:
        return self.last.curve

    @property
    def is_tight(self) -> bool:
        """Whether Newton's first step promises little: loose ropes shrink by a third or more, wherever they touch."""
        curve = self.curve.with_vertices(1.001 / thickness(self.curve) * (self.curve.vertices - self.center))
        mu = 0.03 * (curve.length / len(curve)) ** 2
        return InteriorPoint(curve, mu, lambda _: True, 0.1).step()[1] < 0.1 * curve.length

    @property
    def promise(self) -> float:
        """About how short the rope becomes, compared to others of as many vertices."""
        return self.point.merit if self.point else np.inf

    @property
    def shape(self) -> FloatArray:
        """How far it reaches along its three axes, the root mean squares."""
        x = self.curve.vertices - self.curve.vertices.mean(axis=0)
        return np.asarray(np.linalg.svd(x, compute_uv=False) / len(x) ** 0.5)

    def proves(self, vertices: FloatArray) -> bool:
        return is_rope(self.curve.mesh, self.curve.vertices, vertices, np.array(self.last.radius))

    def follow(
        self, path: Sequence[FloatArray], residual: float | None = None, share: float = 0.0
    ) -> Iterator[Iterate]:
        """The iterate at the end of a path, with proved legs."""
        curve = self.curve.with_vertices(path[-1])
        self.last = replace(
            self.last,
            index=self.last.index + 1,
            curve=curve,
            energy=curve.length / self.unit,
            path=tuple(path),
            gradient_norm=self.last.gradient_norm if residual is None else residual,
            step_size=share,
            edge_length_error=0.0,
        )
        yield self.last

    def remeshed(self, curve: Curve) -> Iterator[Iterate]:
        """The same curve with other vertices on its edges."""
        self.last = replace(self.last, index=self.last.index + 1, curve=curve, path=(), step_size=0.0)
        yield self.last

    def spread(self, flow: Relaxation) -> Iterator[Iterate]:
        """The rope along a flow that spreads it out."""
        for iterate in flow:
            yield from self.follow(iterate.path, iterate.gradient_norm, iterate.step_size)

    def thinned(self, count: int) -> Iterator[Iterate]:
        """As few vertices, as far as the way of the others onto the chords of their neighbours is proved."""
        while len(self.curve) > count:
            # evenly, and no neighbours; of a component half at most, as long as 16 are left
            mesh, every = self.curve.mesh, max(2.0, len(self.curve) / (len(self.curve) - count))
            firsts = mesh.offsets[:-1] + ~np.asarray(mesh.closed)  # ends stay
            gone = [
                np.arange(first, part.stop - 1 if size >= 32 else first, every).astype(np.intp)
                for first, part, size in zip(firsts, mesh.slices, mesh.component_sizes, strict=True)
            ]
            moved = onto_chords(self.curve, np.concatenate(gone))
            if not sum(map(len, gone)) or not self.proves(moved.vertices):
                return
            rest = [
                np.delete(points, k - part.start, axis=0)
                for points, k, part in zip(moved.components, gone, mesh.slices, strict=True)
            ]
            yield from self.follow([moved.vertices])
            yield from self.remeshed(Curve.from_components(rest, self.curve.mesh.closed))

    def shrunk(self) -> Iterator[Iterate]:
        """The curve as small as its thickness allows, and a little larger than its rope needs."""
        if not self.curve.mesh.all_closed:
            return
        start, wanted = self.curve.vertices, 1.001 * self.unit / thickness(self.curve)
        # of the size a twentieth goes or comes at once: changes of lengths cost the checker room
        steps = max(1, math.ceil(abs(math.log(wanted) / math.log(0.95))))
        for k in range(1, steps + 1):
            yield from self.follow([self.center + wanted ** (k / steps) * (start - self.center)])

    def refined(self, vertices: int) -> Iterator[Iterate]:
        """Twice as many vertices on a smoother curve, larger if the rope needs room; nothing if that is blocked.

        Closed ropes of 200, or of a quarter of those that are wanted, are on cubic B-splines from there on, first with
        two vertices for each control point, then with four.  Arcs have more only up to a few edges from where strands
        touch.
        """
        before, point, mesh = self.last, self.point, self.curve.mesh
        counts, per = np.full(mesh.edges, 2), self.per
        n, four = len(self.curve), PER_CONTROL * len(self.curve)
        if per > 1 or (mesh.all_closed and four <= vertices and (n >= 2 * COARSE or 2 * four > vertices)):
            controls, at = [size // per for size in mesh.component_sizes], self.curve.vertices
            if per > 1:
                basis = cubic_splines(controls, per)
                at = factorised(basis.T @ basis).solve(basis.T @ at)
            finer, goal = subdivide(self.curve, counts), cubic_splines(controls, 2 * per) @ at
            per = min(2 * per, PER_CONTROL)
        else:
            touching = np.zeros(0, dtype=np.intp)
            if point is not None and not mesh.all_closed:
                strands = slice(point.contacts.strands)
                touching = np.concatenate([point.contacts.i[strands], point.contacts.j[strands]])
            if len(touching):  # ends stay as they are, up to a few edges from where strands touch
                counts[:], beyond = 1, 4
                for first, last in pairwise(mesh.edge_offsets):
                    if len(own := touching[(touching >= first) & (touching < last)]):
                        counts[max(own.min() - beyond, first) : min(own.max() + beyond + 1, last)] = 2
            finer = subdivide(self.curve, counts)
            onward = finer.mesh.at_tails(0.5 * finer.edge_vectors * np.repeat(counts > 1, counts)[:, None])
            onward[finer.mesh.ends] = 0.0
            goal = finer.vertices + onward
        check_refined(self.curve, finer, ())
        gap = 1e-3 if point is None else point.gap
        larger = max(1.0, (1.0 + 0.5 * gap) * self.unit / thickness(finer.with_vertices(goal)))
        cut = [*self.remeshed(finer)]
        for scale in larger + 0.002 * np.arange(10):
            there = self.center + scale * (goal - self.center)
            if self.proves(there):
                self.per = per
                yield from cut
                yield from self.follow([there])
                if per == 2:
                    yield from self.refined(vertices)
                return
        self.last = before

    def finished(self, vertices: int) -> Iterator[Iterate]:
        """Pulled to the end on so many vertices, or as many as there can be."""
        end = False
        while not end:
            before = len(self.curve)
            if before < vertices:
                yield from self.refined(vertices)
            end = len(self.curve) == before or len(self.curve) >= vertices
            yield from self.pulled(end)

    def pulled(self, end: bool = False) -> Iterator[Iterate]:
        """An interior point's steps, with half as many vertices as the last one, until it is centred, or to the end."""
        curve, last = self.curve.with_vertices((self.curve.vertices - self.center) / self.unit), self.point
        # as the square of edges, so that the barrier is about the same on all meshes, and then less
        square = (self.per * curve.length / len(curve)) ** 2
        mu, margin, basis = 0.03 * square, 0.3, None
        if self.per > 1:
            mu, margin = 5e-4 * square, 0.25 * square
            basis = cubic_splines([size // self.per for size in curve.mesh.component_sizes], self.per)
        elif last is not None:
            mu, margin = 0.25 * FALL * last.mu, FALL**0.5 * last.margin

        def placed(vertices: FloatArray) -> FloatArray:
            return np.asarray(self.center + self.unit * vertices)

        closed, arcs = curve.mesh.all_closed, ~np.asarray(curve.mesh.closed)
        self.point = point = InteriorPoint(
            curve, mu, lambda vertices: self.proves(placed(vertices)), margin, basis=basis
        )
        if not closed:
            point.longest, point.proportions = 2.0, curve.edge_lengths
            point.drawn = 0.0 if last is None else last.drawn
        for share in point.run(GAP if end else None):
            if share > 0.0:
                path = [placed(point.curve.vertices)]
                if not closed:  # what rope comes out of the knot leads ends on, what is pulled in leads them back
                    ahead, ends = point.curve.vertices.copy(), curve.mesh.ends
                    out = 0.5 * arcs * (self.lengths / self.unit - point.curve.component_lengths)
                    if last is not None:  # knots may slide along their ropes without effort; where they are they stay
                        out[arcs] = out[arcs].mean()
                    onward = out[curve.mesh.component[ends], None] * outward(point.curve)
                    ahead[ends] += onward
                    ahead -= onward.mean(axis=(0, 1))  # the middle of all ends stays in its place
                    if is_rope(curve.mesh, path[0], placed(ahead), np.array(self.last.radius)):
                        path.append(placed(ahead))
                        point.curve = point.curve.with_vertices(ahead)
                        point.drawn += 2.0 * float(out.sum())
                yield from self.follow(path, point.residual, share)
