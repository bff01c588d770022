"""Strand moves of a rope: springs lead strands up, or down, over others, and back to the table."""

import math
from collections.abc import Sequence

import numpy as np

from ..base import BoolArray, FloatArray, IntArray
from ..curve import arc_lengths
from ..knots.diagrams.projection import Projection
from ..knots.diagrams.rerouting import StrandMove
from .rope import ElasticRope, Springs
from .ways import Way


class Lead:
    """A strand that is led: its vertices, where they lie, the way to which they are led, and what that costs."""

    def __init__(self, rope: ElasticRope, drawing: Projection, move: StrandMove, way: Way) -> None:
        self.move, mesh = move, rope.mesh
        start, end = way.ends
        part = mesh.slices[mesh.component[int(start)]]
        self.begin, self.size = part.start, part.stop - part.start
        end += self.size * (end < start)
        inner = np.arange(int(start) + 1, math.ceil(end))
        self.vertices = self._wrapped(inner)
        self.first, self.count = int(start) + 1, len(inner)
        if not self.count:
            return
        # rope may slide in from as far as the next vertices that are held
        held = np.flatnonzero(rope.held[part]) + self.begin
        turns = (held[:, None] + self.size * np.arange(-1, 3)).ravel()
        self.least = max(turns[turns <= start], default=self.first - self.size) + 1
        self.most = min(turns[turns >= end], default=math.ceil(end) + self.size)
        self.old = old = rope.seen[self.vertices]
        tips = drawing.placed(np.array(way.ends))
        was, now = arc_lengths(np.vstack([tips[:1], old[:, :2], tips[1:]])), arc_lengths(way.corners)
        self.at = was[1:-1] / was[-1]
        self.new = new = np.column_stack([np.interp(self.at * now[-1], now, x) for x in way.corners.T])
        for _ in range(4):
            new[1:-1] = 0.25 * new[:-2] + 0.5 * new[1:-1] + 0.25 * new[2:]
        self.far = np.linalg.norm(new - old[:, :2], axis=1)
        # springs are stiffer on ways shorter than a face, as they must be gone to their ends, too
        self.firm = np.clip(rope.face / (self.far.max() + 1e-300), 1.0, 7.0) ** 2
        # the area that is swept for each crossing, for which many at once count less
        self.cost = float(self.far.mean() * max(was[-1], now[-1])) / max(move.saved, 0.5) ** 0.7
        both = np.vstack([old[:, :2], new])
        self.low, self.high = both.min(axis=0), both.max(axis=0)

    def lift(self, rope: ElasticRope, rest: BoolArray) -> None:
        """Set the height of the way: above all that may be below it, and more and more if the strand meets itself."""
        up, x = 1.0 if self.move.strand.over else -1.0, rope.seen
        low, high = self.low - 0.5 * rope.face, self.high + 0.5 * rope.face
        below = rest & ((x[:, :2] > low) & (x[:, :2] < high)).all(axis=1)
        ways = (self.old[:, :2] + over * (self.new - self.old[:, :2]) for over in (0.25, 0.5, 0.75))
        clear = 5.0 + 8.0 * any(map(_meets_itself, ways)) * self.at
        top = (up * x[below, 2]).max(initial=0.0) + rope.thick * clear
        self.top = up * np.maximum(top, up * self.old[:, 2])

    def springs(self, rope: ElasticRope, up: float, over: float, hold: float, *, landed: bool) -> Springs:
        """Springs to the way at some moment; rope slides in and out at its ends, so that vertices stay evenly apart."""
        plane = self.old[:, :2] + over * (self.new - self.old[:, :2])
        s, face = arc_lengths(plane), rope.face
        ell = np.linalg.norm(rope.mesh.changes(rope.seen), axis=1).mean()
        grown = int(np.clip(np.clip(s[-1] / (1.1 * ell), 4, 0.6 * self.size) - self.count, -2, 4))
        last = min(self.first + self.count + grown - grown // 2, self.most)
        self.first = max(self.first - grown // 2, self.least)
        self.count = last - self.first
        at = (np.arange(self.count) + 0.5) / self.count
        end = np.clip(np.minimum(at, 1.0 - at) * s[-1] / min(0.3 * s[-1], 0.6 * face), 0.0, 1.0)
        self.bump = end**2 * (3.0 - 2.0 * end)
        x, y, base, top = (np.interp(at * s[-1], s, each) for each in (*plane.T, self.old[:, 2], self.top))
        places = np.column_stack([x, y, base + up * self.bump * (top - base)])
        t = np.gradient(places, axis=0)
        t /= np.linalg.norm(t, axis=1)[:, None] + 1e-300
        # weaker along the strand, and at its ends
        firm = hold * self.firm * (0.1 + 0.9 * self.bump)
        stiffness = firm[:, None, None] * (np.eye(3) - 0.9 * t[:, :, None] * t[:, None])
        if landed:
            stiffness[:, 2] = stiffness[:, :, 2] = 0.0
        return Springs(self._wrapped(self.first + np.arange(self.count)), places, stiffness, landed)

    def _wrapped(self, vertices: IntArray) -> IntArray:
        return np.asarray(self.begin + (vertices - self.begin) % self.size)


def lead(rope: ElasticRope, leads: Sequence[Lead]) -> None:
    """Lead strands all at once as far as they can go."""
    rest = np.ones(rope.mesh.size, dtype=bool)
    rest[np.concatenate([each.vertices for each in leads])] = False
    for each in leads:
        each.lift(rope, rest)

    def springs(up: float, over: float, hold: float = 1.0, landed: bool = False) -> Springs:
        each = [strand.springs(rope, up, over, hold, landed=landed) for strand in leads]
        vertices, places, stiffness = (
            np.concatenate(parts)
            for parts in zip(*((one.vertices, one.places, one.stiffness) for one in each), strict=True)
        )
        return Springs(vertices, places, stiffness, landed)

    def behind(now: Springs) -> float:
        """How far strands are behind their springs, but for their ends, in faces."""
        d = rope.seen[now.vertices] - now.places
        inner = np.concatenate([each.bump for each in leads]) > 0.5
        return float(np.sqrt(np.einsum("ki,kij,kj->k", d, now.stiffness, d))[inner].max(initial=0.0) / rope.face)

    pace = 0.9 * rope.face
    ups = max(2, math.ceil(max(np.abs(each.top - each.old[:, 2]).max() for each in leads) / pace))
    overs = max(3, math.ceil(1.5 * max(each.far.max() for each in leads) / pace))
    moments = [(k / ups, 0.0) for k in range(1, ups + 1)]
    moments += [(1.0, (k / overs) ** 2 * (3.0 - 2.0 * k / overs)) for k in range(1, overs + 1)]
    free = True
    for k, moment in enumerate(moments, 1):
        tries, near = (16, 0.25) if k == len(moments) else (4, 0.6)
        for _ in range(tries):
            now = springs(*moment)
            free = rope.step(now) and free
            if not free or behind(now) < near:
                break
        if behind(now) > 2.0:
            break
    for hold in (1.0, 1.0, 0.7, 0.4, 0.2, 0.05):
        rope.step(springs(1.0, 1.0, hold, landed=True))


def _meets_itself(points: FloatArray) -> bool:
    """Whether a polygon in the plane crosses itself."""
    a, b = points[:-1], points[1:]
    i, j = np.triu_indices(len(a), 2)

    def side(p: FloatArray, q: FloatArray, r: FloatArray) -> FloatArray:
        return np.asarray((q[:, 0] - p[:, 0]) * (r[:, 1] - p[:, 1]) - (q[:, 1] - p[:, 1]) * (r[:, 0] - p[:, 0]))

    first = side(a[i], b[i], a[j]) * side(a[i], b[i], b[j]) < 0
    return bool((first & (side(a[j], b[j], a[i]) * side(a[j], b[j], b[i]) < 0)).any())
