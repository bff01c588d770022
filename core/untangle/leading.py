"""Strand moves of a rope: springs lead strands up, or down, over others, and back to the table."""

from collections.abc import Sequence

import numpy as np

from ..base.types import BoolArray, FloatArray
from ..curve.refine import arc_lengths
from ..knots.diagrams.rerouting import Move
from .drawing import PlaneDrawing
from .rope import ElasticRope, Springs
from .ways import Way

PACE, HOLD = 0.9, 30.0  # how far springs run ahead, in faces, and their stiffness


class Lead:
    """A strand that is led: its vertices, the way along which they lie, and the way to which they are led."""

    def __init__(self, rope: ElasticRope, drawing: PlaneDrawing, move: Move, way: Way) -> None:
        self.move, mesh = move, rope.mesh
        start, end = way.ends
        part = mesh.slices[mesh.component[int(start)]]
        self.begin, self.size = part.start, part.stop - part.start
        end += self.size * (end < start)
        # vertices between those that are held
        held = np.flatnonzero(rope.held[part])
        before, after = held[held <= start - part.start], held[held >= (end - part.start) % self.size]
        self.least = int(start) - (int(start) - part.start - int(before[-1]) - 1 if len(before) else self.size)
        self.most = int(end) + (int(after[0]) - int(end - part.start) % self.size if len(after) else self.size)
        inner = np.arange(int(start) + 1, int(np.ceil(end)))
        self.first, self.count = int(start) + 1, len(inner)
        self.vertices = part.start + (inner - part.start) % self.size
        self.old = rope.seen[self.vertices]
        if self.count < 3:
            return
        tips = drawing.placed(np.array(way.ends))
        was, now = arc_lengths(np.vstack([tips[:1], self.old[:, :2], tips[1:]])), arc_lengths(way.corners)
        self.at = was[1:-1] / was[-1]
        new = np.column_stack([np.interp(self.at * now[-1], now, x) for x in way.corners.T])
        for _ in range(4):
            new[1:-1] = 0.25 * new[:-2] + 0.5 * new[1:-1] + 0.25 * new[2:]
        self.new = new
        self.far = np.linalg.norm(new - self.old[:, :2], axis=1)
        self.cost = float(self.far.mean() * max(was[-1], now[-1]) / max(move.saved, 0.5) ** 0.7)
        both = np.vstack([self.old[:, :2], new])
        self.low, self.high = both.min(axis=0), both.max(axis=0)

    def lift(self, rope: ElasticRope, rest: BoolArray) -> None:
        """Set the height of the way: above all that may be below it, and more and more if the strand meets itself."""
        up = 1.0 if self.move.strand.over else -1.0
        here = rest & ((rope.seen[:, :2] > self.low - 0.5 * rope.face) & (rope.seen[:, :2] < self.high + 0.5 * rope.face)).all(axis=1)
        meets = any(_meets_itself(self.old[:, :2] + b * (self.new - self.old[:, :2])) for b in (0.25, 0.5, 0.75))
        top = (up * rope.seen[here, 2]).max(initial=0.0) + rope.thick * (5.0 + 8.0 * meets * self.at)
        self.base, self.top = self.old[:, 2], up * np.maximum(top, up * self.old[:, 2])

    def springs(self, rope: ElasticRope, up: float, over: float, part: float, *, landed: bool) -> Springs:
        """Springs to the way at some moment; rope slides in and out at its ends, so that vertices stay evenly apart."""
        way = np.column_stack([self.old[:, :2] + over * (self.new - self.old[:, :2]), self.base])
        s = arc_lengths(way[:, :2])
        ell = float(np.linalg.norm(rope.mesh.changes(rope.seen), axis=1).mean())
        want = int(np.clip(s[-1] / (1.1 * ell), 4, 0.6 * self.size))
        grown = int(np.clip(want - self.count, -2, 4))
        first = max(self.first - grown // 2, self.least)
        last = min(self.first + self.count + grown - grown // 2, self.most)
        self.first, self.count = first, last - first
        vertices = self.begin + (first + np.arange(self.count) - self.begin) % self.size
        at = (np.arange(self.count) + 0.5) / self.count
        b = np.clip(np.minimum(at, 1.0 - at) * s[-1] / min(0.3 * s[-1], 0.6 * rope.face), 0.0, 1.0)
        self.bump = b * b * (3.0 - 2.0 * b)
        x, y, base, top = (np.interp(at * s[-1], s, each) for each in (way[:, 0], way[:, 1], self.base, self.top))
        places = np.column_stack([x, y, base + up * self.bump * (top - base)])
        t = np.gradient(places, axis=0)
        t /= np.linalg.norm(t, axis=1)[:, None] + 1e-300
        # weaker along the strand, and at its ends
        stiffness = (part * HOLD * (0.1 + 0.9 * self.bump))[:, None, None] * (np.eye(3) - 0.9 * t[:, :, None] * t[:, None, :])
        if landed:
            stiffness[:, 2] = stiffness[:, :, 2] = 0.0
        return Springs(vertices, places, stiffness, landed)


def lead(rope: ElasticRope, leads: Sequence[Lead]) -> bool:
    """Lead strands all at once as far as they can go; return whether they arrive, or nearly so."""
    rest = np.ones(rope.mesh.size, dtype=bool)
    for each in leads:
        rest[each.vertices] = False
    for each in leads:
        each.lift(rope, rest)
    face = rope.face

    def springs(up: float, over: float, part: float = 1.0, landed: bool = False) -> Springs:
        all_ = [each.springs(rope, up, over, part, landed=landed) for each in leads]
        return Springs(*(np.concatenate([getattr(s, name) for s in all_]) for name in ("vertices", "places", "stiffness")), landed)

    def lag(now: Springs) -> float:
        d = rope.seen[now.vertices] - now.places
        inner = np.concatenate([each.bump for each in leads]) > 0.5
        return float(np.sqrt(np.einsum("ki,kij,kj->k", d, now.stiffness, d) / HOLD)[inner].max(initial=0.0) / rope.face)

    rise = max(np.abs(each.top - each.base).max() for each in leads)
    far = max(each.far.max() for each in leads)
    ups, overs = max(2, int(np.ceil(rise / (PACE * face)))), max(3, int(np.ceil(1.5 * far / (PACE * face))))
    path = [(k / ups, 0.0) for k in range(1, ups + 1)]
    path += [(1.0, (k / overs) ** 2 * (3.0 - 2.0 * k / overs)) for k in range(1, overs + 1)]
    for k, moment in enumerate(path):
        end = k == len(path) - 1
        for _ in range(16 if end else 4):
            now = springs(*moment)
            if not rope.step(now) or lag(now) < (0.25 if end else 0.6):
                break
        if lag(now) > 2.0:
            break
    arrived = lag(now) < 1.0
    for part in (1.0, 1.0, 0.7, 0.4, 0.2, 0.05):
        rope.step(springs(1.0, 1.0, part, True))
    return arrived


def _meets_itself(points: FloatArray) -> bool:
    """Whether a polygon in the plane crosses itself."""
    a, b = points[:-1], points[1:]
    i, j = np.triu_indices(len(a), 2)

    def side(p: FloatArray, q: FloatArray, r: FloatArray) -> FloatArray:
        return np.asarray((q[:, 0] - p[:, 0]) * (r[:, 1] - p[:, 1]) - (q[:, 1] - p[:, 1]) * (r[:, 0] - p[:, 0]))

    first = side(a[i], b[i], a[j]) * side(a[i], b[i], b[j]) < 0
    return bool((first & (side(a[j], b[j], a[i]) * side(a[j], b[j], b[i]) < 0)).any())
