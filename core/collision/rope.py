"""How far a rope can move along straight lines and stay one: strands two radii apart, no corner tighter than the
radius.

A polygon is a rope of radius r if

- arcs of radius r fit into its corners: r (tan(θ/2) + tan(θ'/2)) ≤ ℓ for the turning angles θ, θ' at the ends of every
  edge.  A corner whose bending radius (`bending_radii`) is r or more takes up no more than half of both its edges.
- Two of its points are further apart than 2 r if they are at a distance of π r or more along the curve that has these
  arcs for corners: each shortens the way by r (2 tan(θ/2) − θ).  On different components it is the sum of their radii.
- It is further than r away from obstacles.

All is decided in floating-point numbers with error bounds: what is proved is so.
"""

from collections.abc import Iterator, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np

from ..base import TINY, BoolArray, FloatArray, IntArray
from ..base import column_cross as cross
from ..base import column_dot as dot
from ..curve import Mesh, Obstacle
from .boxes import BoxTree, Level, Test, contact_window, corners, still_triangles
from .motion import Contact, FreeMotion, free_motion, is_free
from .planes import march

_SLACK = 1e-10  # relative to the size of coordinates, far above rounding and far below any radius


def rope_motion(
    mesh: Mesh,
    start: FloatArray,
    end: FloatArray,
    radius: FloatArray | None,
    obstacles: Sequence[Obstacle] = (),
    halvings: int = 4,
) -> FreeMotion:
    """Prove as much as possible of the motion (1−t) start + t end, t ∈ [0, 1], that of a rope.

    ``start`` and ``end`` are the vertices at both ends, shape (n, m) with m = 2 or 3, ``radius`` has one number for
    each component; None is a thread, that must only be free of contact.  Where lengths change too much on the way to
    tell which points count, the time is halved.  Ropes are free of contact: points that count are apart, and between
    others the curve turns by less than π, so that it cannot come back.
    """
    if radius is None:
        return free_motion(mesh, start, end, obstacles)
    if not all(np.isfinite(each).all() for each in (start, end, radius)):
        return FreeMotion(0.0, None, proved=False)
    if not obstacles:  # margins are relative to coordinates: those of curves far away get smaller, where that is exact
        near = start - start[0], end - start[0]
        if not any(_lost(given, start[0], each).any() for given, each in zip((start, end), near, strict=True)):
            start, end = near
    exponent = int(np.frexp(max(np.abs(start).max(), np.abs(end).max(), *(each.size for each in obstacles)))[1])
    points = np.ldexp(start.T, -exponent, order="C"), np.ldexp(end.T, -exponent, order="C")
    own = np.ldexp(radius, -exponent) * (1.0 + _SLACK) + _SLACK
    spans = [p[:, mesh.heads] - p[:, mesh.tails] for p in points]
    limit, edge, saved, turns = _bends(mesh, spans, own[mesh.edge_component])
    met, in_part = None if limit >= 1.0 else Contact((edge, int(mesh.next[edge]))), False
    for places, vertices, names, width in _near(mesh, points, spans, saved, turns, own, obstacles, exponent):
        reached = march(*places, vertices, np.zeros(vertices.shape[1]), limit, width)
        if reached.size and (time := float(reached.min())) < limit:
            edge, other = names[:, reached.argmin()].tolist()
            still = still_triangles(tuple(obstacles), exponent) if len(vertices) == 5 else None
            limit, met = time, Contact((edge,), still.obstacle_of(other).title) if still else Contact((edge, other))
            # a rope touches nowhere at its start: there edges get longer, so that too many of their points count
            in_part = len(vertices) == 4 and (
                places is not points or (time == 0.0 and mesh.edge_component[edge] == mesh.edge_component[other])
            )
    if met is None:
        return FreeMotion(1.0)
    if in_part and halvings and not np.array_equal(start, end):
        middle = 0.5 * (start + end)
        for k, ends in enumerate(((start, middle), (middle, end))):
            found = rope_motion(mesh, *ends, radius, obstacles, halvings - 1)
            if not found.proved:
                return FreeMotion(max(limit, 0.5 * (k + found.time)), found.contact, proved=False)
        return FreeMotion(1.0)
    return FreeMotion(limit, met, proved=False)


def is_rope(
    mesh: Mesh, start: FloatArray, end: FloatArray, radius: FloatArray | None = None, obstacles: Sequence[Obstacle] = ()
) -> bool:
    """Whether the motion from ``start`` to ``end``, each (n, m), is proved that of a rope; see `rope_motion`."""
    if radius is None:
        return is_free(mesh, start, end, obstacles)
    return rope_motion(mesh, start, end, radius, obstacles).proved


def _near(
    mesh: Mesh,
    points: tuple[FloatArray, FloatArray],
    spans: list[FloatArray],
    saved: FloatArray,
    turns: FloatArray,
    radius: FloatArray,
    obstacles: Sequence[Obstacle],
    exponent: int,
) -> Iterator[tuple[tuple[FloatArray, FloatArray], IntArray, IntArray, FloatArray]]:
    """Pairs that may come nearer than they must, in batches; points are (m, n), edges, what arcs save and turns as in
    `_bends`.

    Points (m, k) at both times, indices of x₀, x₁, y₀, y₁ and y₂ of triangles, shape (4 or 5, pairs), numbers of the
    edges, or of edge and triangle, shape (2, pairs), and their least distances, shape (pairs,).
    """
    tree, component = BoxTree.build(mesh, *points), mesh.edge_component
    # no edge is longer on the way than at both its ends, as the norm is convex
    longest = np.sqrt(np.maximum(*(dot(e, e) for e in spans))) * (1.0 + _SLACK) + _SLACK
    position, around = np.cumsum(longest - saved) - longest, np.add.reduceat(longest - saved, mesh.edge_offsets[:-1])
    once_round, batch = np.where(mesh.closed, around, np.inf), 1 << 13
    turned, all_round = np.cumsum(turns), np.add.reduceat(turns, mesh.edge_offsets[:-1])

    def within(width: float) -> Test:
        width = min(width, 2.5)  # more than boxes can be apart, and less than those that only pad the tree are

        def near(level: Level, a: IntArray, others: Level, b: IntArray) -> BoolArray:
            enter, leave = contact_window(level.gaps(a, others, b) - width)
            return enter <= leave

        return near

    widest = float(radius.max())
    for a, b in tree.pairs(within(2.0 * widest)):  # without neighbours, see docs/certificate.md
        i, j = np.sort(tree.order[np.stack([a, b])], axis=0)
        # along the curve between the edges, ahead from i and back
        ways = np.stack([position[j] - position[i] - longest[i], once_round[component[i]] - position[j] - longest[j]])
        ways[1] += position[i]
        ways[:, component[i] != component[j]] = np.inf  # all of their points count
        half = np.pi * radius[component[i]] * (1.0 - _SLACK)
        counts = (ways + longest[i] + longest[j] >= half).all(axis=0)
        i, j, ways, half = i[counts], j[counts], ways[:, counts], half[counts]
        whole = (ways >= half).all(axis=0)
        for k in range(0, int(whole.sum()), batch):
            a, b = i[whole][k : k + batch], j[whole][k : k + batch]
            yield points, corners(mesh, a, b), np.stack([a, b]), radius[component[a]] + radius[component[b]]
        # of others only the parts that are half a circle apart or more count
        i, j, ways, half = i[~whole], j[~whole], ways[:, ~whole], half[~whole]
        # Edges between the two that turn by φ are within φ/2 of a direction, along which the way from one to the other
        # leads by π r cos φ/2 or more: far enough, and so that a checker sees it that looks at a bit too much
        turn = turned[j] - turned[i]
        turn = np.where(ways[1] < ways[0], all_round[component[i]] - turn, turn)
        bent = np.cos(0.5 * np.minimum(turn, np.pi)) < 0.7  # which 2/π would do for
        i, j, ways, half = i[bent], j[bent], ways[:, bent], half[bent]
        back, rest = ways[1] < ways[0], half - ways.min(axis=0)
        for steps in (4, 16):  # in which that border is followed, more where they do not suffice
            ends, pair = _beyond(mesh, points, spans, longest, i, j, back, rest, steps)
            vertices: IntArray = np.arange(4 * len(pair)).reshape(4, -1)
            width = 2.0 * radius[component[i[pair]]]
            if steps == 16:
                yield ends, vertices, np.stack([i[pair], j[pair]]), width
                continue
            near = np.unique(pair[march(*ends, vertices, np.zeros(len(pair)), 1.0, width) < 1.0])
            if not len(near):
                break
            i, j, back, rest = i[near], j[near], back[near], rest[near]
    if obstacles:
        still = still_triangles(tuple(obstacles), exponent)
        corners_of = np.ldexp(still.vertices.T, -exponent)
        first, last = (np.concatenate([p, corners_of], axis=1) for p in points)
        for a, b in tree.pairs_with(still.tree, within(widest)):
            for k in range(0, len(a), batch):
                edges, others = a[k : k + batch], b[k : k + batch]
                vertices = np.concatenate([tree.corners[:, edges], mesh.size + still.tree.corners[:, others]])
                names = np.stack([tree.order[edges], still.tree.order[others]])
                yield (first, last), vertices, names, radius[component[names[0]]]


def _beyond(
    mesh: Mesh,
    points: tuple[FloatArray, FloatArray],
    spans: list[FloatArray],
    longest: FloatArray,
    i: IntArray,
    j: IntArray,
    back: BoolArray,
    rest: FloatArray,
    steps: int,
) -> tuple[tuple[FloatArray, FloatArray], IntArray]:
    """The parts of edges i and j that are farther apart along the curve than their nearest ends by ``rest``, but for a
    step, at both times, as points x₀, x₁, y₀, y₁ one after the other, (m, 4k); and the pair that each is of, (k,).

    The way from i to j leads ``back`` or ahead.
    """
    step = np.arange(steps)[:, None] / steps
    # from the distance u on of i, and from v to w of j, as shares of the edges from the ends that are nearer
    u = np.maximum(rest * (1.0 - step - 1.0 / steps), 0.0) / longest[i]
    v = rest * step / longest[j]
    w = np.where(step + 1.0 / steps == 1.0, 1.0, np.minimum(rest * (step + 1.0 / steps) / longest[j], 1.0))
    pair = np.broadcast_to(np.arange(len(i)), u.shape)[there := (u <= 1.0) & (v <= 1.0)]
    u, v, w, back = u[there], v[there], w[there], back[pair]
    edge, whole = np.stack([i, i, j, j])[:, pair], np.ones_like(u)
    share = np.where(back, [u, whole, 1.0 - v, 1.0 - w], [1.0 - u, 0.0 * whole, v, w])
    start, end = (
        (p[:, mesh.tails[edge]] + share * e[:, edge]).reshape(len(p), -1) for p, e in zip(points, spans, strict=True)
    )
    return (start, end), pair


def _lost(x: FloatArray, y: FloatArray, difference: FloatArray) -> FloatArray:
    """What rounding takes from x − y (Knuth, The Art of Computer Programming 2, 4.2.2, theorem B)."""
    z = difference - x
    return (x - (difference - z)) - (y + z)


class Corners(NamedTuple):
    """Corners between edges e and f during a leg, their vectors at both times, each (m, k)."""

    e: tuple[FloatArray, FloatArray]
    f: tuple[FloatArray, FloatArray]

    def tangents(self) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Bounds of tan(θ/2) = |e × f|/(|e||f| + ⟨e, f⟩) from below and above, and those of |e| and |f| from below.

        Products of moving vectors are quadratic polynomials in time, between their coefficients in Bernstein's basis.
        """
        normals = [cross(u, v) for u, v in product(self.e, self.f)]
        middle = 0.5 * (normals[1] + normals[2])
        length = np.sqrt(dot(middle, middle))
        normals[1:3] = [middle]
        largest = np.sqrt(np.max([dot(n, n) for n in normals], axis=0))
        smallest = np.min([dot(n, middle) for n in normals], axis=0) / np.maximum(length, TINY)

        def between(u: tuple[FloatArray, FloatArray], v: tuple[FloatArray, FloatArray]) -> FloatArray:
            return np.stack([dot(u[0], v[0]), 0.5 * (dot(u[0], v[1]) + dot(u[1], v[0])), dot(u[1], v[1])])

        ee, ff, ef = between(self.e, self.e), between(self.f, self.f), between(self.e, self.f)
        a, b = (np.sqrt(np.maximum(each.min(axis=0), 0.0)) for each in (ee, ff))
        longest = np.sqrt(np.maximum(ee[0], ee[2]) * np.maximum(ff[0], ff[2]))  # the norm is convex
        least = a * b + ef.min(axis=0)
        above = np.where(least > _SLACK * longest, largest / np.maximum(least, TINY) + _SLACK, np.inf)
        below = smallest / np.maximum(longest + ef.max(axis=0), TINY) * (1.0 - _SLACK) - _SLACK
        return np.maximum(below, 0.0), above, a, b

    def halves(self, k: IntArray) -> "Corners":
        """Some of them in the first half of the time, and then these in the second."""
        (e, e1), (f, f1) = ((u[:, k], v[:, k]) for u, v in self)
        starts, middles, ends = (e, f), (0.5 * (e + e1), 0.5 * (f + f1)), (e1, f1)
        first, last = (
            [np.concatenate(each, axis=1) for each in zip(*two, strict=True)]
            for two in ((starts, middles), (middles, ends))
        )
        return Corners((first[0], last[0]), (first[1], last[1]))


def shortcut(x: FloatArray) -> FloatArray:
    """No more than x − arctan x, for x ≥ 0, nearly that, and made of quotients of polynomials."""
    y = 1.0 / np.maximum(x, 1.0)
    small, large = x**3 / (3.0 + 1.8 * x**2), x - 1.5708 + y - y**3 / 3.0 + y**5 / 5.0 - y**7 / 7.0
    return np.maximum(small, large)


def _bends(
    mesh: Mesh, spans: list[FloatArray], radius: FloatArray, halvings: int = 14
) -> tuple[float, int, FloatArray, FloatArray]:
    """The time up to which arcs fit into corners, 1 if always, the edge that limits it, and for the tail of each edge
    what its arc takes off the way at least, r (2 tan(θ/2) − θ), and the angle θ at most.

    ``spans`` are the edges at both times, each (m, edges), radii are by edge.  Where the bounds do not suffice the time
    is halved.
    """
    edges = np.arange(mesh.edges)
    before, after = mesh.previous, mesh.next

    def corners(k: IntArray, j: IntArray) -> Corners:
        return Corners((spans[0][:, k], spans[1][:, k]), (spans[0][:, j], spans[1][:, j]))

    low, high, _, own = corners(before, edges).tangents()
    is_corner = before != edges
    saved = np.where(is_corner, 2.0 * radius * shortcut(low), 0.0)
    high = np.where(is_corner, high, 0.0)
    turns = 2.0 * np.arctan(high)
    needed = high + np.where(after != edges, high[after], 0.0)
    which = np.flatnonzero(radius * needed * (1.0 + _SLACK) > own - _SLACK)
    if not len(which):
        return 1.0, 0, saved, turns
    if np.array_equal(spans[0], spans[1]):  # halves of the time would be the same
        return 0.0, int(which[0]), saved, turns
    first, size, k, limit, worst = np.zeros(len(which)), 1.0, np.arange(len(which)), 1.0, int(which[0])
    tail, head = corners(before[which], which), corners(which, after[which])
    for _ in range(halvings):
        tail, head, size = tail.halves(k), head.halves(k), 0.5 * size
        which, first = np.tile(which[k], 2), np.concatenate([first[k], first[k] + size])
        (low, high, _, own), (below, above, _, _) = tail.tangents(), head.tangents()
        corner, other, r = is_corner[which], after[which] != which, radius[which]
        fails = r * (np.where(corner, high, 0.0) + np.where(other, above, 0.0)) * (1.0 + _SLACK) > own - _SLACK
        # where arcs do not fit at any time nothing later matters
        longest = np.sqrt(np.max([dot(f, f) for f in tail.f], axis=0))
        ends = r * (np.where(corner, low, 0.0) + np.where(other, below, 0.0)) > longest
        if ends.any() and (time := float(first[ends].min())) < limit:
            limit, worst = time, int(which[ends][first[ends].argmin()])
        k = np.flatnonzero(fails & (first < limit))
        if not len(k):
            return limit, worst, saved, turns
    return float(first[k].min()), int(which[k][first[k].argmin()]), saved, turns
